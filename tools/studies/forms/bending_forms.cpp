/// What bends: strips and sheets of denim. Triangles bend as a plate of Poisson's ratio 1/3 does,
/// so a narrow strip of them curls across and is softer by a ninth; here strips are wide where they
/// bend little, and where they bend much their own stretching keeps them cylinders.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/studies/forms/elastica.h"
#include "tools/studies/forms/form.h"
#include "tools/studies/forms/oscillation.h"
#include "tools/studies/forms/sheets.h"

namespace weft::tools::forms {
namespace {

Material denim() {
  Material m = find_material("denim").value();
  m.damping_bending = 0;
  return m;
}

double load_of(const Material& m, double length) {
  return m.density * kGravity * std::pow(length, 3) / m.bending;
}

/// How far the free end of a clamped strip comes to hang below the clamp.
Reading hung(Pattern pattern, const Material& material, double length, double width, int cells,
             int frames, double expected) {
  const Strip strip = clamped_strip(pattern, material, length, width, cells);
  Run run(strip.scene, {.tolerance = 1e-3});
  run.steps(frames, kFrame);
  return run.reading(size_of(strip.sheet), 1e3 * expected, -1e3 * run.mean_y(strip.end));
}

Reading cantilever(Pattern pattern, int refinement) {
  constexpr double kLength = 0.02;
  Material material = denim();
  material.damping_motion = 200;
  const double width = pattern == Pattern::quads ? kLength / 2 : 2 * kLength;
  return hung(pattern, material, kLength, width, 4 << refinement, 30,
              load_of(material, kLength) / 8 * kLength);
}

/// Of this bending, from the softest cloth to plates: the strip is so long that it sags by a
/// twentieth, but 0.4 m at most. Its motion decays as fast as its first mode swings.
Reading cantilever_of(Pattern pattern, double bending, int refinement) {
  constexpr double kLoad = 0.4, kLongest = 0.4, kDensity = 0.8;
  constexpr double kTensile = 2e5;  // N/m
  const double length = std::min(kLongest, std::cbrt(kLoad * bending / (kDensity * kGravity)));
  const double load = load_of({.density = kDensity, .bending = bending}, length);
  const double swings = std::sqrt(12.36 * kGravity / (load * length));  // rad/s
  const Material material{.density = kDensity,
                          .warp = kTensile,
                          .weft = kTensile,
                          .shear = kTensile / 2,
                          .bending = bending,
                          .damping_motion = swings};
  const double width = pattern == Pattern::quads ? length / 2 : 2 * length;
  const int frames = static_cast<int>(std::ceil(20 / (swings * kFrame)));
  return hung(pattern, material, length, width, 4 << refinement, frames,
              -heavy_elastica(load).y * length);
}

Reading heavy(Pattern pattern, int refinement) {
  constexpr double kLength = 0.06;
  Material material = denim();
  material.damping_motion = 20;
  return hung(pattern, material, kLength, kLength / 2, 8 << refinement, 90,
              -heavy_elastica(load_of(material, kLength)).y * kLength);
}

struct Buckled {
  double height = 0, length = 0;  // m
  Reading cost{};
};

/// A strip between two hinges, which come nearer by a fifth of its length. A little weight upwards
/// shows it the way, and is taken away again.
Buckled buckled(Pattern pattern, double length, double nearer, int refinement) {
  constexpr int kFrames = 30;
  Material material = denim();
  material.damping_motion = 20;
  const Sheet sheet = sheet_of(pattern, length, length / 4, 8 << refinement);
  MeshDescription mesh = mesh_of(sheet, material);
  pin(mesh, [&](Vec3 p) { return std::min(p.x, length - p.x) < 1e-9; });
  SceneDescription scene = scene_of(mesh);
  scene.gravity = {0, 1, 0};
  Run run(scene, {.tolerance = 1e-3});
  for (int frame = 1; frame <= kFrames; ++frame) {
    const double left = 1 - nearer * frame / kFrames;
    run.move_pins(scene, [&](Vec3 p) { return Vec3{left * p.x, 0, p.z}; });
    run.step(kFrame);
  }
  (void)run.cloth().set_gravity({});
  run.steps(2 * kFrames, kFrame);
  Buckled b;
  for (std::uint32_t i = 0; i < scene.positions.size(); ++i)
    b.height = std::max(b.height, run.at(i).y);
  const auto rim = particles_at(scene, [](Vec3 p) { return p.z < 1e-9; });
  for (std::size_t k = 1; k < rim.size(); ++k) {
    const Vec3 p = run.at(rim[k - 1]), q = run.at(rim[k]);
    b.length += std::hypot(q.x - p.x, q.y - p.y, q.z - p.z);
  }
  b.cost = run.reading(size_of(sheet), 0, 0);
  return b;
}

Reading buckled(Pattern pattern, bool asks_height, int refinement) {
  constexpr double kLength = 0.1, kNearer = 0.2;
  const Buckled b = buckled(pattern, kLength, kNearer, refinement);
  Reading reading = b.cost;
  reading.expected = 1e3 * kLength * (asks_height ? buckled_height(kNearer) : 1);
  reading.measured = 1e3 * (asks_height ? b.height : b.length);
  return reading;
}

/// Of a clamped beam: cos(z) cosh(z) = -1.
constexpr double kFirstMode = 1.875104;

/// In its first mode, `height` high at its end; particles of the clamp stay.
void bend(Strip& strip, double length, double height) {
  const double last = strip.clamp * 4 / 3 + 1e-9;
  for (Vec3& p : strip.scene.positions) {
    if (p.x < last) continue;
    const double z = kFirstMode * (p.x - strip.clamp) / length;
    p.y = height / 2 * (std::cosh(z) - std::cos(z) - 0.734096 * (std::sinh(z) - std::sin(z)));
  }
}

Reading swing(Pattern pattern, double tau, int cells, int substeps) {
  constexpr double kLength = 0.02, kHeight = 2e-4;
  constexpr int kParts = 16;
  Material material = denim();
  material.damping_bending = tau;
  const double width = pattern == Pattern::quads ? kLength / 2 : 2 * kLength;
  Strip strip = clamped_strip(pattern, material, kLength, width, cells);
  strip.scene.gravity = {};
  bend(strip, kLength, kHeight);
  const double free = kFirstMode * kFirstMode * std::sqrt(material.bending / material.density) /
                      (kLength * kLength);
  const double ratio = tau * free / 2, damped = free * std::sqrt(1 - ratio * ratio);
  Run run(strip.scene, {.tolerance = 1e-3, .substeps = substeps});
  const double dt = 2 * kPi / damped / kParts;
  std::vector<double> samples;
  run.steps(kParts, dt);
  for (int i = 0; i < 3 * kParts; ++i) {
    run.step(dt);
    samples.push_back(run.mean_y(strip.end));
  }
  const Oscillation seen = oscillation_of(samples, dt);
  return tau > 0 ? run.reading(size_of(strip.sheet), 2 * kPi * ratio / std::sqrt(1 - ratio * ratio),
                               seen.decrement)
                 : run.reading(size_of(strip.sheet), damped, seen.frequency);
}

/// J, of bending elements.
double bending_energy(const SceneDescription& scene, double radius, double angle) {
  double energy = 0;
  for (const BendingElement& b : scene.bending) {
    Vec3 d;
    for (std::size_t i = 0; i < 4 && b.particles[i] != kNoIndex; ++i) {
      const Vec3 p = rolled(scene.positions[b.particles[i]], radius, angle);
      d = {d.x + b.weights[i] * p.x, d.y + b.weights[i] * p.y, d.z + b.weights[i] * p.z};
    }
    const double more = std::hypot(d.x, d.y, d.z) - b.rest;
    energy += more * more / (2 * b.compliance);
  }
  return energy;
}

/// What a square stores as a cylinder, in that of 16 directions that is farthest off. Its particles
/// are where the cylinder has them: in irregular triangles they would store up to a tenth less
/// if they settled, which is what cloth_from_mesh aims at. The time is that of the same square when
/// it swings down from one of its sides.
Reading cylinder(Pattern pattern, int refinement) {
  constexpr double kSide = 0.2, kRadius = 0.1;
  constexpr int kDirections = 16;
  const Material material = denim();
  const Sheet sheet = sheet_of(pattern, kSide, kSide, 8 << refinement);
  MeshDescription mesh = mesh_of(sheet, material);
  pin(mesh, [](Vec3 p) { return p.x < 1e-9; });
  const SceneDescription scene = scene_of(mesh);
  const double expected = material.bending * sheet.length * sheet.width / (2 * kRadius * kRadius);
  double farthest = expected;
  for (int i = 0; i < kDirections; ++i) {
    const double energy = bending_energy(scene, kRadius, kPi * i / kDirections);
    if (std::abs(energy - expected) > std::abs(farthest - expected)) farthest = energy;
  }
  Run run(scene, {});
  run.steps(10, kFrame);
  return run.reading(size_of(sheet), 1e6 * expected, 1e6 * farthest);
}

}  // namespace

std::vector<Form> bending_forms() {
  std::vector<Form> forms;
  for (const Pattern pattern : {Pattern::quads, Pattern::equilateral}) {
    const std::string of = fmt::format(", {}", name(pattern));
    forms.push_back({"a cantilever sags" + of, "rho g L^4 / 8 k_b", "mm",
                     [=](int r) { return cantilever(pattern, r); }});
    forms.push_back({"the heavy elastica" + of, "k_b theta'' = - rho g (L - s) cos theta", "mm",
                     [=](int r) { return heavy(pattern, r); }});
    forms.push_back({"a strip buckles" + of, "L p / K(p), 2 E(p) / K(p) - 1 = 0.8", "mm",
                     [=](int r) { return buckled(pattern, true, r); }});
    forms.push_back({"and keeps its length" + of, "L", "mm",
                     [=](int r) { return buckled(pattern, false, r); }});
    forms.push_back({"a cantilever swings" + of, "1.8751^2 sqrt(k_b / rho) / L^2", "rad/s",
                     [=](int r) { return swing(pattern, 0, 4 << r, 16 << (2 * r)); }});
    forms.push_back({"its decrement" + of, "2 pi z / sqrt(1 - z^2), z = tau omega / 2", "",
                     [=](int r) { return swing(pattern, 3e-4, 4 + 2 * r, 32 << (2 * r)); }});
  }
  forms.push_back({fmt::format("a cantilever sags, {}", name(Pattern::irregular)),
                   "rho g L^4 / 8 k_b", "mm",
                   [=](int r) { return cantilever(Pattern::irregular, r); }, 0.06, false});
  for (const double bending : {1e-6, 1e-3, 2., 20.}) {
    for (const Pattern pattern :
         {Pattern::quads, Pattern::right_angled, Pattern::jittered, Pattern::irregular}) {
      const bool is_regular = pattern == Pattern::quads || pattern == Pattern::right_angled;
      forms.push_back({fmt::format("a cantilever of {:g} N m, {}", bending, name(pattern)),
                       "k_b theta'' = - rho g (L - s) cos theta", "mm",
                       [=](int r) { return cantilever_of(pattern, bending, r); },
                       is_regular ? 0.02 : 0.05, is_regular});
    }
  }
  for (const Pattern pattern :
       {Pattern::quads, Pattern::right_angled, Pattern::equilateral, Pattern::irregular}) {
    forms.push_back({fmt::format("cylinders, {}", name(pattern)), "k_b kappa^2 / 2 per area", "uJ",
                     [=](int r) { return cylinder(pattern, r); },
                     pattern == Pattern::irregular ? 0.1 : 0.05, pattern != Pattern::irregular});
  }
  return forms;
}

}  // namespace weft::tools::forms
