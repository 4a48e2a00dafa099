/// (i, j) at (0, -i L, j L): upright. (0, 0) and (0, N-1) are fixed, as far apart as in the sheet,
/// so that its upper edge can only hang by the strain that is tolerated.
#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Layout banner_layout(const Options& options) {
  const Grid grid{options.size};
  Layout layout = grid_sheet(options.size, [&](int i, int j) {
    return Vec3{0, -grid.fraction(i), grid.fraction(j)};
  });
  layout.pins = {grid.number(0, 0), grid.number(0, grid.size - 1)};
  return layout;
}

}  // namespace

BuiltIn banner() {
  return {.summary = "a sheet hangs from two corners at its own width",
          .smallest_size = 3,
          .make = cloth<banner_layout>};
}

}  // namespace weft::scenes::built_in
