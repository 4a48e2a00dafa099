/// N is odd; (i, j) at (i L, -sqrt(1 - 0.81) min(j L, 1 - j L), 0.9 j L): folded along its middle
/// row, every edge at its rest length. (0, 0) and (0, N-1) are fixed: all of its weight runs
/// through the whole sheet.
#include <algorithm>
#include <cmath>

#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Result<Layout> corners_layout(const Options& options) {
  constexpr double kSpan = 0.9;
  if (options.size % 2 == 0) return refused("size", "odd", options.size);
  const double fall = std::sqrt(1 - kSpan * kSpan);
  const Grid grid{options.size};
  Layout layout = grid_sheet(options.size, [&](int i, int j) {
    const double along = grid.fraction(j);
    const double to_border = grid.fraction(std::min(j, grid.size - 1 - j));
    return Vec3{grid.fraction(i), -fall * to_border, kSpan * along};
  });
  layout.rest = flat(grid);
  layout.pins = {grid.number(0, 0), grid.number(0, grid.size - 1)};
  return layout;
}

}  // namespace

BuiltIn corners() {
  return {.summary = "a folded sheet hangs from two corners",
          .smallest_size = 3,
          .usual_size = 21,
          .make = cloth<corners_layout>};
}

}  // namespace weft::scenes::built_in
