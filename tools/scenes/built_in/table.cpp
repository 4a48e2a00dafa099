/// (i, j) at (i L, 0.001, j L): a sheet that lies on the top of a box, which carries 0.4 m of it,
/// and slides off its edge; friction 0.2.
#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Layout table_layout(const Options& options) { return sheet_on_table(options.size, 0.2); }

}  // namespace

BuiltIn table() {
  return {.summary = "a sheet of cotton slides off a table",
          .is_fabric = true,
          .smallest_size = 3,
          .make = cloth<table_layout>};
}

}  // namespace weft::scenes::built_in
