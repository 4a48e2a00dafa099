/// (i, j) at (i L, 0, j L); its border is fixed. A ball of radius 0.15 is pressed 6 cm into it,
/// rolls 0.2 m along x, and slides back; friction 0.4.
#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Layout cushion_layout(const Options& options) {
  constexpr double kRadius = 0.15, kThickness = 1e-3, kDepth = 0.06, kWay = 0.2;  // m
  constexpr double kHeight = kRadius + kThickness, kTurn = kWay / kRadius;        // rad
  Layout layout = level_sheet(options.size);
  const Grid grid = *layout.grid;
  for (int i = 0; i < grid.size; ++i) {
    for (int j = 0; j < grid.size; ++j) {
      const bool is_inner = i > 0 && j > 0 && i + 1 < grid.size && j + 1 < grid.size;
      if (!is_inner) layout.pins.push_back(grid.number(i, j));
    }
  }
  const Vec3 from{0.5 - kWay / 2, kHeight, 0.5};
  const tools::PinMove move{
      .times = {0, 1, 2, 3},
      .translations = {{}, {0, -kDepth, 0}, {kWay, -kDepth, 0}, {0, -kDepth, 0}},
      .rotations = {{}, {}, {0, 0, -kTurn}, {0, 0, -kTurn}},
      .about = from};
  layout.bodies.push_back({.shape = weft::Ball{.radius = kRadius},
                           .position = from,
                           .thickness = kThickness,
                           .friction = 0.4,
                           .move = move});
  return layout;
}

}  // namespace

BuiltIn cushion() {
  return {.summary = "a ball is pressed into a taut sheet, rolls and slides",
          .is_fabric = true,
          .smallest_size = 3,
          .make = cloth<cushion_layout>};
}

}  // namespace weft::scenes::built_in
