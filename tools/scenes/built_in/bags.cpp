/// Five level sheets of 0.5 m, N x N each, lie as the dots of a die. A ball of 0.08 m lies on each,
/// of 20 to 500 g. The corners of the sheets are lifted and come together in 1.2 s, and then go by
/// 0.3 m along x: five bags swing. Balls do not touch each other, so each has a bag of its own.
#include <array>
#include <cstddef>
#include <cstdint>

#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

constexpr std::array<Vec3, 5> kDots{
    {{0, 0, 0}, {-0.6, 0, -0.6}, {-0.6, 0, 0.6}, {0.6, 0, -0.6}, {0.6, 0, 0.6}}};  // m
constexpr double kWidth = 0.5, kOpen = 0.24;                                       // m

/// The corners that are on these sides of their sheets take it.
tools::PinMove gathering(double x_side, double z_side) {
  constexpr double kLift = 0.35, kSway = 0.3, kInwards = (kWidth - kOpen) / 2;  // m
  const Vec3 up{-x_side * kInwards, kLift, -z_side * kInwards};
  return {.times = {0, 1.2, 1.5, 2}, .translations = {{}, up, up, {up.x + kSway, up.y, up.z}}};
}

tools::SceneBody ball(Vec3 on, double mass) {
  constexpr double kRadius = 0.08, kThickness = 1e-3;  // m
  const ShapeDescription shape = weft::Ball{.radius = kRadius};
  const auto built = build_shape(shape).value();
  const double density = mass / mass_of(*built, 1).value().mass;
  return {.shape = shape,
          .position = {on.x, on.y + kRadius + kThickness, on.z},
          .thickness = kThickness,
          .mass = mass_of(*built, density).value()};
}

Layout bags_layout(const Options& options) {
  constexpr std::array kMasses{0.02, 0.05, 0.1, 0.2, 0.5};  // kg
  const Grid grid{options.size};
  const int last = grid.size - 1;
  Layout layout;
  for (const double x_side : {-1, 1}) {
    for (const double z_side : {-1, 1}) layout.moves.push_back(gathering(x_side, z_side));
  }
  for (std::size_t bag = 0; bag < kDots.size(); ++bag) {
    const Vec3 middle = kDots[bag];
    const auto first = static_cast<std::uint32_t>(layout.start.size());
    const auto place = [&](int i, int j) {
      return Vec3{middle.x + kWidth * (grid.fraction(i) - 0.5), 0,
                  middle.z + kWidth * (grid.fraction(j) - 0.5)};
    };
    add_sheet(grid.size, grid.size, place, layout);
    const int corners[4][2]{{0, 0}, {0, last}, {last, 0}, {last, last}};
    for (std::size_t k = 0; k < 4; ++k) {
      layout.pins.push_back(first + grid.number(corners[k][0], corners[k][1]));
      layout.moves[k].particles.push_back(layout.pins.back());
    }
    layout.bodies.push_back(ball(middle, kMasses[bag]));
  }
  return layout;
}

}  // namespace

BuiltIn bags() {
  return {.summary = "cloths are gathered around balls of 20 to 500 g, and swing",
          .is_fabric = true,
          .smallest_size = 9,
          .make = cloth<bags_layout>};
}

}  // namespace weft::scenes::built_in
