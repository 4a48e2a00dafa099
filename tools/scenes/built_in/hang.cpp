/// (i, j) at (i L, 0, j L); the row i = 0 is fixed.
#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Layout hang_layout(const Options& options) { return hanging_sheet(options.size); }

}  // namespace

BuiltIn hang() {
  return {.summary = "a sheet with one fixed side swings down", .make = cloth<hang_layout>};
}

}  // namespace weft::scenes::built_in
