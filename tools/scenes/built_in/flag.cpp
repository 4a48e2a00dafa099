/// (i, j) at (i L, -j L, 0); the row i = 0 is fixed, in a wind of (8, 0, 2) m/s.
#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Layout flag_layout(const Options& options) {
  const Grid grid{options.size};
  Layout layout = grid_sheet(options.size, [&](int i, int j) {
    return Vec3{grid.fraction(i), -grid.fraction(j), 0};
  });
  layout.pins = first_row(grid);
  layout.wind = {8, 0, 2};
  return layout;
}

}  // namespace

BuiltIn flag() {
  return {.summary = "a sheet of cotton flies from a pole",
          .is_fabric = true,
          .make = cloth<flag_layout>};
}

}  // namespace weft::scenes::built_in
