/// 2 m long and 0.125 m wide, upright, with waves of 5 mm. Its upper end is lowered in five
/// seconds, from 2.02 m above the floor to 0.12 m. It has self-contact.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Layout ribbon_layout(const Options& options) {
  constexpr double kLength = 2, kWidth = 0.125;                  // m
  constexpr double kHeight = 0.02, kLowered = 1.9;               // m
  constexpr double kWave = 0.005, kWavelength = 0.25, kEnd = 5;  // m, m, s
  const Grid grid{options.size};
  const int rows = 1 + static_cast<int>(kLength) * (grid.size - 1);
  const int columns = std::max(2, 1 + static_cast<int>(std::lround(kWidth / grid.spacing())));
  const std::vector<Vec3> line = chords(rows, grid.spacing(), [&](double s) {
    return Vec3{kWave * std::sin(2 * std::numbers::pi * s / kWavelength), kHeight + s, 0};
  });
  Layout layout;
  const auto place = [&](int i, int j) {
    const Vec3 at = line[static_cast<std::size_t>(i)];
    return Vec3{at.x, at.y, grid.spacing() * j};
  };
  add_sheet(rows, columns, place, layout);
  layout.rest = flat(rows, columns, grid.spacing());
  tools::PinMove move{.times = {0, kEnd}, .translations = {{}, {0, -kLowered, 0}}};
  for (int j = 0; j < columns; ++j)
    move.particles.push_back(static_cast<std::uint32_t>((rows - 1) * columns + j));
  layout.pins = move.particles;
  layout.moves.push_back(move);
  add_floor(0, layout);
  layout.touches_itself = true;
  return layout;
}

}  // namespace

BuiltIn ribbon() {
  return {.summary = "a ribbon of cotton is lowered on a floor",
          .is_fabric = true,
          .smallest_size = 20,
          .make = cloth<ribbon_layout>};
}

}  // namespace weft::scenes::built_in
