/// Strips that a force or a moment bends by their end, without weight.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/studies/forms/elastica.h"
#include "tools/studies/forms/form.h"
#include "tools/studies/forms/sheets.h"

namespace weft::tools::forms {
namespace {

constexpr double kLength = 0.4, kBending = 2;  // m, N m

/// Its motion decays as fast as its first mode swings.
Material plate() {
  constexpr double kDensity = 0.8, kTensile = 2e5;
  return {.density = kDensity,
          .warp = kTensile,
          .weft = kTensile,
          .shear = kTensile / 2,
          .bending = kBending,
          .damping_motion = 3.516 * std::sqrt(kBending / kDensity) / (kLength * kLength)};
}

double width_of(Pattern pattern) { return pattern == Pattern::quads ? kLength / 2 : 2 * kLength; }

/// A row of particles across the strip, each with the share of the width that it has.
struct Row {
  std::vector<std::uint32_t> particles;
  std::vector<double> shares;
};

Row row_at(const Strip& strip, double x) {
  constexpr double kNear = 1e-9;
  const double across = strip.sheet.across, width = strip.sheet.width;
  Row row{particles_at(strip.scene, [&](Vec3 p) { return std::abs(p.x - x) < kNear; }), {}};
  for (const std::uint32_t i : row.particles) {
    const double z = strip.scene.positions[i].z;
    const bool is_outside = z < kNear || z > width - kNear;
    row.shares.push_back((is_outside ? 0.5 : 1) / across);
  }
  return row;
}

void add(std::vector<Vec3>& forces, const Row& row, Vec3 force) {
  for (std::size_t k = 0; k < row.particles.size(); ++k) {
    Vec3& at = forces[row.particles[k]];
    const double share = row.shares[k];
    at = {at.x + share * force.x, at.y + share * force.y, at.z + share * force.z};
  }
}

/// The cantilever with an end shear force of Sze, Liu and Lo (2004), under its full load.
Reading sheared(Pattern pattern, int refinement) {
  constexpr double kLoad = 4;
  constexpr int kFrames = 90;
  const Strip strip = clamped_strip(pattern, plate(), kLength, width_of(pattern), 4 << refinement);
  SceneDescription scene = strip.scene;
  scene.gravity = {};
  Run run(scene, {.tolerance = 1e-3});
  std::vector<Vec3> forces(scene.positions.size());
  const double force = kLoad * kBending / (kLength * kLength) * strip.sheet.width;
  add(forces, row_at(strip, strip.sheet.length), {0, -force, 0});
  run.pull(forces);
  run.steps(kFrames, kFrame);
  return run.reading(size_of(strip.sheet), -1e3 * end_loaded_elastica(kLoad).y * kLength,
                     -1e3 * run.mean_y(strip.end));
}

/// A couple of forces, on the last row of cells, turns the end of a strip and turns with it, more
/// and more until the strip is a circle.
Reading rolled(int refinement) {
  constexpr int kFrames = 120, kRest = 60;
  const int cells = 8 << refinement;
  const Strip strip =
      clamped_strip(Pattern::quads, plate(), kLength, width_of(Pattern::quads), cells);
  const double cell = kLength / (cells + 0.5), moment = 2 * kPi * kBending / kLength;
  SceneDescription scene = strip.scene;
  scene.gravity = {};
  Run run(scene, {.tolerance = 1e-3});
  const Row last = row_at(strip, strip.sheet.length),
            before = row_at(strip, strip.sheet.length - cell);
  double angle = 0;
  for (int frame = 1; frame <= kFrames + kRest; ++frame) {
    const double force = std::min(1.0, double(frame) / kFrames) * moment * strip.sheet.width / cell;
    const Vec3 up{-std::sin(angle) * force, std::cos(angle) * force, 0};
    std::vector<Vec3> forces(scene.positions.size());
    add(forces, last, up);
    add(forces, before, {-up.x, -up.y, 0});
    run.pull(forces);
    run.step(kFrame);
    const Vec3 a = run.at(before.particles[0]), b = run.at(last.particles[0]);
    angle += std::remainder(std::atan2(b.y - a.y, b.x - a.x) - angle, 2 * kPi);
  }
  return run.reading(size_of(strip.sheet), 360 * (1 - cell / (2 * kLength)), 180 / kPi * angle);
}

}  // namespace

std::vector<Form> end_forms() {
  std::vector<Form> forms;
  for (const Pattern pattern : {Pattern::quads, Pattern::right_angled, Pattern::irregular}) {
    const bool is_regular = pattern != Pattern::irregular;
    forms.push_back({fmt::format("a force bends a strip by its end, {}", name(pattern)),
                     "k_b theta'' = - P cos theta", "mm",
                     [=](int r) { return sheared(pattern, r); }, is_regular ? 0.02 : 0.05,
                     is_regular});
  }
  forms.push_back({"a moment rolls a strip up, quads", "M (L - a / 2) / k_b = 2 pi (1 - a / 2 L)",
                   "degrees", [](int r) { return rolled(r); }});
  return forms;
}

}  // namespace weft::tools::forms
