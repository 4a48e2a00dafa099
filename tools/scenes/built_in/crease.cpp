/// A sheet in two layers on a floor, joined by a half circle of a radius of 2 cm. A board presses
/// the fold for 0.2 s, and is lifted. Both edges are fixed; the upper one goes back over the fold
/// in two seconds. A material that does not yield yields at 40 1/m. It has self-contact.
#include <cstddef>
#include <numbers>
#include <vector>

#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

constexpr double kCreaseRadius = 0.02, kCreaseHeight = 1e-3;  // m
constexpr double kCreaseStraight = (1 - std::numbers::pi * kCreaseRadius) / 2;
constexpr double kCreaseFold = kCreaseStraight / 2;  // m, where it is

/// Down onto the lower layer, and back over the fold.
tools::PinMove opening() {
  constexpr double kSlack = 0.02, kLower = 2 * kCreaseRadius - 2e-3;
  constexpr double kOut = 1 - kSlack - 2 * kCreaseStraight;  // m
  return {.times = {0, 0.5, 1.5, 3.5},
          .translations = {{}, {0, -kLower, 0}, {0, -kLower, 0}, {kOut, 2 * kCreaseRadius, 0}},
          .rotations = {{}, {}, {}, {0, 0, -std::numbers::pi}},
          .about = {kCreaseFold, kCreaseHeight, 0}};
}

tools::SceneBody board() {
  constexpr double kPressed = 3.5e-3, kWide = 0.2, kThick = 0.02, kLift = 0.4;  // m
  const tools::PinMove presses{.times = {0, 0.8, 1, 1.5},
                               .translations = {{0, kLift, 0}, {}, {}, {0, kLift, 0}}};
  return {.shape = box({kWide, kThick, 1.4}),
          .position = {kCreaseFold, kPressed + kThick / 2, 0},
          .move = presses};
}

Layout crease_layout(const Options& options) {
  constexpr double kYield = 40;  // 1/m
  const Grid grid{options.size};
  const std::vector<Vec3> line = chords(grid.size, grid.spacing(), [](double s) {
    return zigzag(s, kCreaseStraight, kCreaseRadius);
  });
  Layout layout;
  const auto place = [&](int i, int j) {
    const Vec3 at = line[static_cast<std::size_t>(i)];
    return Vec3{at.x, at.y + kCreaseHeight, grid.fraction(j) - 0.5};
  };
  add_sheet(grid.size, grid.size, place, layout);
  layout.rest = flat(grid.size, grid.size, grid.spacing());
  layout.pins = first_row(grid);
  tools::PinMove opens = opening();
  for (int j = 0; j < grid.size; ++j) opens.particles.push_back(grid.number(grid.size - 1, j));
  layout.pins.insert(layout.pins.end(), opens.particles.begin(), opens.particles.end());
  layout.moves.push_back(opens);
  add_floor(0, layout);
  layout.bodies.push_back(board());
  layout.yield = kYield;
  layout.touches_itself = true;
  return layout;
}

}  // namespace

BuiltIn crease() {
  return {.summary = "a folded sheet of cotton is pressed by a board, and opened",
          .is_fabric = true,
          .smallest_size = 20,
          .make = cloth<crease_layout>};
}

}  // namespace weft::scenes::built_in
