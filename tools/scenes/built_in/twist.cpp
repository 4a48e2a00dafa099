/// N rows along x, of as many vertices as make it 0.2 m wide. In six seconds its ends turn by three
/// turns against each other, and come nearer by 0.2 m. It has self-contact.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Layout twist_layout(const Options& options) {
  constexpr double kWidth = 0.2, kNearer = 0.2;  // m
  constexpr double kTurns = 3, kEnd = 6;         // of one end against the other; s
  constexpr int kKeys = 60;
  const Grid grid{options.size};
  const int columns = std::max(3, 1 + static_cast<int>(std::lround(kWidth / grid.spacing())));
  const double width = grid.spacing() * (columns - 1);
  Layout layout;
  const auto place = [&](int i, int j) {
    return Vec3{grid.fraction(i) - 0.5, 0, grid.spacing() * j - width / 2};
  };
  add_sheet(grid.size, columns, place, layout);
  for (const double side : {-1.0, 1.0}) {
    tools::PinMove move;
    for (int j = 0; j < columns; ++j)
      move.particles.push_back(
          static_cast<std::uint32_t>(side < 0 ? j : (grid.size - 1) * columns + j));
    for (int key = 0; key <= kKeys; ++key) {
      const double share = static_cast<double>(key) / kKeys;
      move.times.push_back(kEnd * share);
      move.rotations.push_back({side * std::numbers::pi * kTurns * share, 0, 0});
      move.translations.push_back({-side * kNearer / 2 * share * share, 0, 0});
    }
    layout.pins.insert(layout.pins.end(), move.particles.begin(), move.particles.end());
    layout.moves.push_back(move);
  }
  layout.touches_itself = true;
  return layout;
}

}  // namespace

BuiltIn twist() {
  return {.summary = "the ends of a sheet of cotton turn against each other",
          .is_fabric = true,
          .smallest_size = 5,
          .make = cloth<twist_layout>};
}

}  // namespace weft::scenes::built_in
