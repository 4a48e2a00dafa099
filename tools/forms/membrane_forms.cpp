/// What stretches and shears: strips and patches of cotton.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/forms/form.h"
#include "tools/forms/oscillation.h"
#include "tools/forms/sheets.h"

namespace weft::tools::forms {
namespace {

constexpr double kGravity = 10, kFrame = 1.0 / 60;
constexpr double kPi = std::numbers::pi;

Material cotton() { return find_material("cotton").value(); }

/// N/m, of a strip along its warp; of triangles, which have none, the mean.
double stiffness(Pattern pattern, const Material& m) {
  return pattern == Pattern::quads ? m.warp : (m.warp + m.weft) / 2;
}

/// A strip of a metre comes to rest under its own weight.
Reading weighed(Pattern pattern, int refinement) {
  Material material = cotton();
  material.damping_motion = 200;
  const Strip strip = hanging_strip(sheet_of(pattern, 1, 0.125, 8 << refinement), material);
  Run run(strip.scene, {.tolerance = 2e-6});
  run.steps(15, kFrame);
  const double expected = material.density * kGravity / (2 * stiffness(pattern, material));
  return run.reading(size_of(strip.sheet), 1e3 * expected, 1e3 * (-1 - run.mean_y(strip.end)));
}

/// J, of springs.
double membrane_energy(const SceneDescription& scene, const Run& run) {
  double energy = 0;
  for (const Constraint& c : scene.constraints) {
    const Vec3 a = run.at(c.a), b = run.at(c.b);
    const double longer = std::hypot(a.x - b.x, a.y - b.y, a.z - b.z) - c.rest_length;
    energy += longer * longer / (2 * c.compliance);
  }
  return energy;
}

/// The stiffness k of a patch whose rim an affine deformation by the strain e has moved, so that it
/// stores k e^2 / 2 per area: what is within has followed by itself.
Reading deformed(Pattern pattern, const std::function<Vec3(Vec3, double e)>& moved, double expected,
                 int refinement) {
  constexpr double kSide = 0.2, kStrain = 0.01;
  constexpr int kFrames = 10;
  const Sheet sheet = sheet_of(pattern, kSide, kSide, 4 << refinement);
  Material material = cotton();
  material.damping_motion = 50;
  // Along one diagonal a sheared patch is pressed: it would come out of its plane in wrinkles.
  material.bending = 0.1;
  MeshDescription mesh = mesh_of(sheet, material);
  pin(mesh, [&](Vec3 p) {
    return std::min({p.x, p.z, sheet.length - p.x, sheet.width - p.z}) < 1e-9;
  });
  SceneDescription scene = scene_of(mesh);
  scene.gravity = {};
  Run run(scene, {.tolerance = 1e-3, .substeps = 50 << refinement});
  for (int frame = 1; frame <= 3 * kFrames; ++frame) {
    const double strain = kStrain * std::min(frame, kFrames) / kFrames;
    run.move_pins(scene, [&](Vec3 p) { return moved(p, strain); });
    run.step(kFrame);
  }
  const double area = sheet.length * sheet.width;
  return run.reading(size_of(sheet), expected,
                     2 * membrane_energy(scene, run) / (area * kStrain * kStrain));
}

struct Swing {
  Strip strip;
  double frequency = 0, ratio = 0;  ///< what is expected; of critical damping
  Oscillation seen{};
  Reading cost{};
};

/// A strip of a metre that swings along itself in its first mode, for four periods; the first is
/// left out, since the clamp, which holds its width, makes others as well.
Swing swing(Pattern pattern, double tau, int refinement) {
  constexpr int kParts = 16;
  constexpr double kStretch = 2e-3;
  Material material = cotton();
  material.damping_stretch = tau;
  Swing swing{.strip = hanging_strip(sheet_of(pattern, 1, 0.125, 8 << refinement), material)};
  SceneDescription& scene = swing.strip.scene;
  scene.gravity = {};
  const double free = kPi / 2 * std::sqrt(stiffness(pattern, material) / material.density);
  swing.ratio = tau * free / 2;
  swing.frequency = free * std::sqrt(1 - swing.ratio * swing.ratio);
  std::vector<Vec3> bent = scene.positions;
  for (Vec3& p : bent) p.y -= kStretch * std::sin(-kPi / 2 * p.y);
  scene.positions = bent;
  Run run(scene, {.tolerance = 2e-6, .substeps = 32 << refinement});
  const double dt = 2 * kPi / swing.frequency / kParts;
  std::vector<double> samples;
  run.steps(kParts, dt);
  for (int i = 0; i < 3 * kParts; ++i) {
    run.step(dt);
    samples.push_back(run.mean_y(swing.strip.end) + 1);
  }
  swing.seen = oscillation_of(samples, dt);
  swing.cost = run.reading(size_of(swing.strip.sheet), 0, 0);
  return swing;
}

Reading frequency(Pattern pattern, int refinement) {
  const Swing s = swing(pattern, 0, refinement);
  Reading reading = s.cost;
  reading.expected = s.frequency;
  reading.measured = s.seen.frequency;
  return reading;
}

Reading decrement(Pattern pattern, int refinement) {
  const Swing s = swing(pattern, 5e-4, refinement);
  Reading reading = s.cost;
  reading.expected = 2 * kPi * s.ratio / std::sqrt(1 - s.ratio * s.ratio);
  reading.measured = s.seen.decrement;
  return reading;
}

Vec3 pulled(Vec3 p, double e) { return {p.x + e * p.x, p.y, p.z}; }
Vec3 sheared(Vec3 p, double e) { return {p.x, p.y, p.z + e * p.x}; }

void add(std::vector<Form>& forms, Pattern pattern, double pull, const char* pull_text,
         double shear, const char* shear_text) {
  const std::string of = fmt::format(", {}", name(pattern));
  forms.push_back(
      {"a strip hangs" + of, "rho g L^2 / 2 k", "mm", [=](int r) { return weighed(pattern, r); }});
  forms.push_back({"a patch is pulled" + of, pull_text, "N/m",
                   [=](int r) { return deformed(pattern, pulled, pull, r); }});
  forms.push_back({"a patch is sheared" + of, shear_text, "N/m",
                   [=](int r) { return deformed(pattern, sheared, shear, r); }});
  forms.push_back({"a strip swings along" + of, "pi / 2 L sqrt(k / rho)", "rad/s",
                   [=](int r) { return frequency(pattern, r); }});
  forms.push_back({"its decrement" + of, "2 pi z / sqrt(1 - z^2), z = tau omega / 2", "",
                   [=](int r) { return decrement(pattern, r); }});
}

}  // namespace

std::vector<Form> membrane_forms() {
  std::vector<Form> forms;
  const Material m = cotton();
  const double k = stiffness(Pattern::equilateral, m);
  add(forms, Pattern::quads, m.warp, "warp", m.shear, "shear");
  add(forms, Pattern::equilateral, 9. / 8 * k, "9/8 k", 3. / 8 * k, "3/8 k");
  return forms;
}

}  // namespace weft::tools::forms
