/// Five level sheets 1 cm above each other and a floor, each turned by 0.1 rad against the one
/// under it. They have self-contact.
#include <cmath>

#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Layout stack_layout(const Options& options) {
  constexpr int kLayers = 5;
  constexpr double kApart = 0.01, kTurn = 0.1;  // m, rad
  const Grid grid{options.size};
  Layout layout;
  for (int layer = 0; layer < kLayers; ++layer) {
    const double c = std::cos(kTurn * layer), s = std::sin(kTurn * layer);
    const auto place = [&](int i, int j) {
      const double x = grid.fraction(i) - 0.5, z = grid.fraction(j) - 0.5;
      return Vec3{c * x + s * z, kApart * (layer + 1), c * z - s * x};
    };
    add_sheet(grid.size, grid.size, place, layout);
  }
  add_floor(0, layout);
  layout.touches_itself = true;
  return layout;
}

}  // namespace

BuiltIn stack() {
  return {.summary = "five sheets of cotton fall on a floor, one on another",
          .is_fabric = true,
          .smallest_size = 3,
          .make = cloth<stack_layout>};
}

}  // namespace weft::scenes::built_in
