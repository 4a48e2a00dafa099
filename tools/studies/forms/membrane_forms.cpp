/// What stretches and shears: strips and patches of cotton.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/program/measure/fabric_laws.h"
#include "tools/studies/forms/form.h"
#include "tools/studies/forms/oscillation.h"
#include "tools/studies/forms/sheets.h"

namespace weft::tools::forms {
namespace {

/// Springs along diagonals add twice the shear to the product of two stretches: 1.7 % of a pull at
/// 45 degrees.
constexpr double kPatchBound = 0.03;

/// A strip of a metre comes to rest under its own weight.
Reading weighed(Pattern pattern, int refinement) {
  Material material = cotton();
  material.damping_motion = 200;
  const Strip strip = hanging_strip(sheet_of(pattern, 1, 0.125, 8 << refinement), material);
  Run run(strip.scene, {.tolerance = 5e-7});
  run.steps(15, kFrame);
  const double expected = material.density * kGravity / (2 * material.warp);
  return run.reading(size_of(strip.sheet), 1e3 * expected, 1e3 * (-1 - run.mean_y(strip.end)));
}

/// A strip whose warp runs at 45 degrees to it hangs from its end: how far what is away from the
/// clamp by three times its width comes down beyond that place.
Reading weighed_on_the_bias(int refinement) {
  constexpr double kFrom = 0.375;
  Material material = cotton();
  material.damping_motion = 200;
  MeshDescription mesh =
      hanging_mesh(sheet_of(Pattern::irregular, 1, 0.125, 8 << refinement), material);
  mesh.warp = {{1, 1, 0}};
  const SceneDescription scene = scene_of(mesh);
  const double half_cell = 0.0625 / (1 << refinement);
  const auto from = particles_at(scene, [&](Vec3 p) { return std::abs(p.y + kFrom) < half_cell; });
  const auto end = particles_at(scene, [](Vec3 p) { return p.y < -1 + 1e-9; });
  Run run(scene, {.tolerance = 1e-4, .substeps = 128 << refinement});
  const double rest = 1 + run.mean_y(from);  // m, of what hangs below
  run.steps(30, kFrame);
  const double softness = 1 / material.warp + 1 / material.weft + 1 / material.shear;
  return run.reading(fmt::format("{} x {} cells", 8 << refinement, 1 << refinement),
                     1e3 * material.density * kGravity * rest * rest / 2 * softness / 4,
                     1e3 * (run.mean_y(from) - run.mean_y(end) - rest));
}

/// J, of a triangle of fabric.
double energy_of(const MembraneElement& m, const Run& run) {
  const auto& [a, b, c] = m.particles;
  const FabricStrain strain = fabric_strain(m, run.at(a), run.at(b), run.at(c));
  return rest_area(m) / 2 *
         (m.warp * strain.warp * strain.warp + m.weft * strain.weft * strain.weft +
          m.shear * strain.shear * strain.shear);
}

/// J, of springs and triangles.
double membrane_energy(const SceneDescription& scene, const Run& run) {
  double energy = 0;
  for (const Constraint& c : scene.constraints) {
    const Vec3 a = run.at(c.a), b = run.at(c.b);
    const double longer = std::hypot(a.x - b.x, a.y - b.y, a.z - b.z) - c.rest_length;
    energy += longer * longer / (2 * c.compliance);
  }
  for (const MembraneElement& element : scene.membrane) energy += energy_of(element, run);
  return energy;
}

/// A deformation of a level sheet by the strain e: by e along one direction for each metre along
/// another, which lie at angles to x, where the warp runs.
struct Deformation {
  double of = 0, along = 0;  ///< rad
  Vec3 operator()(Vec3 p, double e) const {
    const double by = e * (p.x * std::cos(of) + p.z * std::sin(of));
    return {p.x + by * std::cos(along), p.y, p.z + by * std::sin(along)};
  }
};
Deformation pulled(double angle) { return {angle, angle}; }
Deformation sheared(double angle) { return {angle, angle + kPi / 2}; }

/// N/m: it stores k e^2 / 2 per area.
double stiffness(const Material& m, const Deformation& d) {
  const double warp = std::cos(d.of) * std::cos(d.along);
  const double weft = std::sin(d.of) * std::sin(d.along);
  const double shear = std::sin(d.of + d.along);
  return m.warp * warp * warp + m.weft * weft * weft + m.shear * shear * shear;
}

/// The stiffness of a patch whose rim an affine deformation has moved: what is within has followed
/// by itself.
Reading deformed(Pattern pattern, const Deformation& moved, int refinement) {
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
  Run run(scene, {.tolerance = 1e-4, .substeps = 200 << refinement});
  for (int frame = 1; frame <= 3 * kFrames; ++frame) {
    const double strain = kStrain * std::min(frame, kFrames) / kFrames;
    run.move_pins(scene, [&](Vec3 p) { return moved(p, strain); });
    run.step(kFrame);
  }
  const double area = sheet.length * sheet.width;
  return run.reading(size_of(sheet), stiffness(material, moved),
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
  const double free = kPi / 2 * std::sqrt(material.warp / material.density);
  swing.ratio = tau * free / 2;
  swing.frequency = free * std::sqrt(1 - swing.ratio * swing.ratio);
  std::vector<Vec3> bent = scene.positions;
  for (Vec3& p : bent) p.y -= kStretch * std::sin(-kPi / 2 * p.y);
  scene.positions = bent;
  Run run(scene, {.tolerance = 5e-7, .substeps = 32 << refinement});
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

void add_strips(std::vector<Form>& forms, Pattern pattern) {
  const std::string of = fmt::format(", {}", name(pattern));
  forms.push_back({"a strip hangs" + of, "rho g L^2 / 2 warp", "mm",
                   [=](int r) { return weighed(pattern, r); }});
  forms.push_back({"a strip swings along" + of, "pi / 2 L sqrt(warp / rho)", "rad/s",
                   [=](int r) { return frequency(pattern, r); }});
  forms.push_back({"its decrement" + of, "2 pi z / sqrt(1 - z^2), z = tau omega / 2", "",
                   [=](int r) { return decrement(pattern, r); }});
}

void add_patches(std::vector<Form>& forms, Pattern pattern) {
  for (const int degrees : {0, 30, 45, 80}) {
    const std::string at = fmt::format(" at {} degrees, {}", degrees, name(pattern));
    const double angle = kPi * degrees / 180;
    forms.push_back({"a patch is pulled" + at, "warp c^4 + weft s^4 + 4 shear c^2 s^2", "N/m",
                     [=](int r) { return deformed(pattern, pulled(angle), r); }, kPatchBound,
                     false});
    forms.push_back({"a patch is sheared" + at, "(warp + weft) c^2 s^2 + shear (c^2 - s^2)^2",
                     "N/m", [=](int r) { return deformed(pattern, sheared(angle), r); },
                     kPatchBound, false});
  }
}

}  // namespace

std::vector<Form> membrane_forms() {
  std::vector<Form> forms;
  for (const Pattern pattern : {Pattern::quads, Pattern::equilateral, Pattern::irregular})
    add_strips(forms, pattern);
  forms.push_back({"a strip hangs on the bias, irregular triangles",
                   "rho g L^2 / 8 (1 / warp + 1 / weft + 1 / shear)", "mm", weighed_on_the_bias});
  for (const Pattern pattern :
       {Pattern::quads, Pattern::jittered, Pattern::irregular, Pattern::patchwork})
    add_patches(forms, pattern);
  return forms;
}

}  // namespace weft::tools::forms
