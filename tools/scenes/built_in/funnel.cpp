/// The part within 10 cm of the middle of a level sheet is drawn down by a metre in six seconds,
/// through a ring of triangles that is 0.28 m wide inside; friction 0.1. It has self-contact.
#include <cmath>
#include <cstdint>

#include "tools/scenes/body_meshes.h"
#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Layout funnel_layout(const Options& options) {
  constexpr double kRing = 0.16, kTube = 0.02, kClearance = 0.01;  // m, middle to middle; radius
  constexpr double kHeld = 0.1, kWay = 1, kEnd = 6;                // m, m, s
  const Grid grid{options.size};
  Layout layout;
  const auto place = [&](int i, int j) {
    return Vec3{grid.fraction(i) - 0.5, kTube + kClearance, grid.fraction(j) - 0.5};
  };
  add_sheet(grid.size, grid.size, place, layout);
  tools::PinMove move{.times = {0, kEnd}, .translations = {{}, {0, -kWay, 0}}};
  for (std::uint32_t v = 0; v < layout.start.size(); ++v) {
    const Vec3 at = layout.start[v];
    if (std::hypot(at.x, at.z) < kHeld) move.particles.push_back(v);
  }
  layout.pins = move.particles;
  layout.moves.push_back(move);
  layout.bodies.push_back({.shape = ring_mesh(kRing, kTube, 48, 12), .friction = 0.1});
  layout.touches_itself = true;
  return layout;
}

}  // namespace

BuiltIn funnel() {
  return {.summary = "a sheet of cotton is drawn through a ring",
          .is_fabric = true,
          .smallest_size = 20,
          .make = cloth<funnel_layout>};
}

}  // namespace weft::scenes::built_in
