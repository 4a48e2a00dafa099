/// Soap films: stretch alone, of cloth that has no size of its own.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "tools/studies/forms/form.h"
#include "tools/studies/forms/sheets.h"

namespace weft::tools::forms {
namespace {

constexpr double kRadius = 0.1, kHeight = 0.1;  // m, of two rings; between them

/// c of c cosh(h / 2 c) = r, the catenoid that is stable.
double waist() {
  double low = kRadius / 2, high = kRadius;
  for (int i = 0; i < 60; ++i) {
    const double c = (low + high) / 2;
    (c * std::cosh(kHeight / (2 * c)) < kRadius ? low : high) = c;
  }
  return (low + high) / 2;
}

/// A film between two rings, that is a cylinder in the beginning. Its threads are so short at rest
/// that it pulls by its stretch alone, which is least in a conformal map of a flat strip, whose
/// coordinates are harmonic: a catenoid, if the strip has the catenoid's proportions.
Reading catenoid(Pattern pattern, int refinement) {
  constexpr double kShrunk = 1e-2, kTension = 1, kDensity = 0.1;  // N/m, kg/m^2
  constexpr int kFrames = 90;
  const double c = waist();
  const int along = 8 << refinement;
  Sheet sheet{.pattern = pattern, .length = kHeight / c, .width = 2 * kPi, .along = along};
  sheet.across = static_cast<int>(std::round(sheet.width * along / sheet.length));
  MeshDescription mesh = mesh_of(sheet, {.density = kDensity / (kShrunk * kShrunk),
                                         .warp = kTension / kShrunk,
                                         .weft = kTension / kShrunk,
                                         .damping_motion = 40});
  for (Vec3& p : mesh.positions) {
    mesh.rest_positions.push_back({kShrunk * c * p.x, 0, kShrunk * c * p.z});
    const double angle = p.z > 2 * kPi - 1e-9 ? 0 : p.z;
    p = {kRadius * std::cos(angle), c * p.x - kHeight / 2, kRadius * std::sin(angle)};
  }
  pin(mesh, [](Vec3 p) { return std::abs(p.y) > kHeight / 2 - 1e-9; });
  SceneDescription scene = scene_of(mesh);
  scene.gravity = {};
  const auto middle = particles_at(scene, [](Vec3 p) { return std::abs(p.y) < 1e-9; });
  // Laws are relative to lengths at rest.
  Run run(scene, {.tolerance = 1e-3 / kShrunk});
  run.steps(kFrames, kFrame);
  double radius = 0;
  for (const std::uint32_t i : middle) radius += std::hypot(run.at(i).x, run.at(i).z);
  return run.reading(size_of(sheet), 1e3 * c, 1e3 * radius / static_cast<double>(middle.size()));
}

}  // namespace

std::vector<Form> film_forms() {
  std::vector<Form> forms;
  for (const Pattern pattern : {Pattern::quads, Pattern::right_angled}) {
    forms.push_back({fmt::format("a soap film between two rings, {}", name(pattern)),
                     "c cosh(h / 2 c) = r", "mm", [=](int r) { return catenoid(pattern, r); }, 0.02,
                     false});
  }
  return forms;
}

}  // namespace weft::tools::forms
