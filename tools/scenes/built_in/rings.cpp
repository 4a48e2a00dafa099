/// An upright sheet in slight waves, so that it knows where to fold, hangs with its two upper
/// corners and seven rings on a rod of friction 0.2. One corner is drawn by 0.6 m along the rod in
/// 1.5 s, and back. It has self-contact.
#include <cmath>

#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Layout rings_layout(const Options& options) {
  constexpr int kRings = 8, kWaves = 8;
  constexpr double kWave = 0.005, kPulled = 0.6, kFriction = 0.2;  // m, m, 1
  const Grid grid{options.size};
  const int last = grid.size - 1;
  Layout layout = grid_sheet(options.size, [&](int i, int j) {
    const double wave = kWave * std::sin(2 * M_PI * kWaves * grid.fraction(j)) * grid.fraction(i);
    return Vec3{grid.fraction(j), -grid.fraction(i), wave};
  });
  Rod rod{{-0.1, 0, 0}, {1.1, 0, 0}, kFriction};
  for (int k = 1; k < kRings; ++k) rod.rings.push_back(grid.number(0, k * last / kRings));
  layout.rod = rod;
  layout.pins = {grid.number(0, 0), grid.number(0, last)};
  layout.moves.push_back({.particles = {grid.number(0, last)},
                          .times = {0.2, 1.7, 2.2, 3.7},
                          .translations = {{}, {-kPulled, 0, 0}, {-kPulled, 0, 0}, {}}});
  layout.touches_itself = true;
  return layout;
}

}  // namespace

BuiltIn rings() {
  return {.summary = "a curtain of cotton on rings is drawn along a rod, and back",
          .is_fabric = true,
          .smallest_size = 9,
          .make = cloth<rings_layout>};
}

}  // namespace weft::scenes::built_in
