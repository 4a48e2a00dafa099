/// The table, 0.6 m above a floor; its friction is 0.03, so that the whole sheet slides off. It has
/// self-contact.
#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Layout curtain_layout(const Options& options) {
  constexpr double kTable = 0.6, kFriction = 0.03;  // m, above the floor
  Layout layout = sheet_on_table(options.size, kFriction);
  add_floor(-kTable, layout);
  layout.touches_itself = true;
  return layout;
}

}  // namespace

BuiltIn curtain() {
  return {.summary = "a sheet of cotton slides off a table onto the floor",
          .is_fabric = true,
          .smallest_size = 3,
          .make = cloth<curtain_layout>};
}

}  // namespace weft::scenes::built_in
