#include "tests/support/clothes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <utility>

#include "tests/support/vectors.h"

namespace weft::test {

SceneDescription scene_of(std::string_view name, int size) {
  scenes::Options options;
  options.size = size;
  auto scene = scenes::make(name, options);
  REQUIRE_MESSAGE(scene, scene.error());
  return scene.value();
}

std::shared_ptr<const Model> model_of(const SceneDescription& scene) {
  auto model = build_model(scene);
  REQUIRE_MESSAGE(model, model.error());
  return model.value();
}

Cloth cloth_of(const SceneDescription& scene, const Settings& settings) {
  auto cloth = Cloth::create(model_of(scene), settings);
  REQUIRE_MESSAGE(cloth, cloth.error());
  return std::move(cloth.value());
}

SceneDescription with(SceneDescription scene, const Changes& changes) {
  for (const std::uint32_t i : changes.release) std::erase(scene.fixed, i);
  for (const std::uint32_t i : changes.fix) scene.fixed.push_back(i);
  for (const ChangedValue& c : changes.masses) scene.masses[c.index] = c.value;
  for (const ChangedValue& c : changes.rest_lengths)
    scene.constraints[c.index].rest_length = c.value;
  for (const ChangedValue& c : changes.compliances) scene.constraints[c.index].compliance = c.value;
  for (const ChangedMembrane& c : changes.membrane) {
    scene.membrane[c.index].warp = c.warp;
    scene.membrane[c.index].weft = c.weft;
    scene.membrane[c.index].shear = c.shear;
  }
  for (const ChangedValue& c : changes.bending) scene.bending[c.index].compliance = c.value;
  if (changes.damping) scene.damping = *changes.damping;
  if (changes.air) {
    scene.air.density = changes.air->density;
    scene.air.drag = changes.air->drag;
    scene.air.lift = changes.air->lift;
    scene.air.ram = changes.air->ram;
  }
  return scene;
}

StepReport step(Cloth& cloth, double dt) {
  auto report = cloth.step(dt);
  REQUIRE_MESSAGE(report, report.error());
  return report.value();
}

void run(Cloth& cloth, double dt, int steps) {
  for (int i = 0; i < steps; ++i) step(cloth, dt);
}

std::vector<Vec3> positions(const Cloth& cloth) {
  std::vector<Vec3> out(cloth.particle_count());
  REQUIRE(cloth.read_positions(std::span<Vec3>(out)));
  return out;
}

std::vector<Vec3> velocities(const Cloth& cloth) {
  std::vector<Vec3> out(cloth.particle_count());
  REQUIRE(cloth.read_velocities(out));
  return out;
}

double largest_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  REQUIRE(a.size() == b.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, distance(a[i], b[i]));
  return largest;
}

SceneDescription free_bar(double mass_a, double mass_b) {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}};
  scene.velocities = {{0, 0, 0}, {0, 0, 0}};
  scene.masses = {mass_a, mass_b};
  scene.constraints = {{0, 1, 1.0}};
  scene.gravity = {0, 0, 0};
  return scene;
}

SceneDescription free_rope(double start_distance) {
  SceneDescription scene = free_bar(1, 1);
  scene.positions[1] = {start_distance, 0, 0};
  scene.constraints[0].kind = ConstraintKind::rope;
  return scene;
}

SceneDescription early_pull() {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0.3, 0, 0}, {0.6, 0, 0}, {1.5, 0, 0}, {-0.35, 0, 0}};
  scene.velocities = {{0, 0, 0}, {25, 0, 0}, {25, 0, 0}, {25, 0, 0}, {0, 0, 0}};
  scene.masses = {1, 1, 1, 2, 1};
  scene.fixed = {0};
  scene.constraints = {{4, 2, 1.0, ConstraintKind::rope},
                       {2, 3, 1.0, ConstraintKind::rope},
                       {0, 1, 0.3},
                       {2, 1, 0.3}};
  scene.gravity = {0, 0, 0};
  return scene;
}

Backend each_backend() {
  Backend backend = Backend::reference;
  SUBCASE("on the reference backend") { backend = Backend::reference; }
  SUBCASE("on the simd backend") { backend = Backend::simd; }
  return backend;
}

Settings on(Backend backend, Settings settings) {
  settings.backend = backend;
  return settings;
}

std::string text(const Method& method) {
  return std::string(name(method.backend)) + ", " + std::string(name(method.directions)) +
         (method.anticipate ? ", anticipate" : "") + (method.skip ? ", skip" : "");
}

Settings with(Settings settings, const Method& method) {
  settings.measuring.directions = method.directions;
  settings.measuring.anticipate = method.anticipate;
  settings.measuring.skip = method.skip;
  settings.backend = method.backend;
  return settings;
}

Settings tight(double tolerance) {
  Settings settings = paper_settings();
  settings.tolerance = tolerance;
  settings.contact_tolerance = tolerance;
  settings.velocity_tolerance = tolerance;
  return settings;
}

double exactness(Backend backend, double exact, double corrected) {
  return backend == Backend::reference ? exact : exact + corrected * 0x1p-22;
}

}  // namespace weft::test
