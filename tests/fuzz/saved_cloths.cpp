#include "tests/fuzz/saved_cloths.h"

#include <algorithm>

#include "engine/saving/sealed.h"
#include "tests/fuzz/checks.h"
#include "tests/fuzz/stepping.h"
#include "tests/support/shapes.h"

namespace weft::fuzz {
namespace {

/// What small steps alone know.
SceneDescription with_everything() {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 0, 1}, {2, 0, 1}};
  scene.masses.assign(scene.positions.size(), 1);
  scene.fixed = {0};
  scene.constraints = {{0, 1, 1}, {1, 2, 1, ConstraintKind::rope, 1e-4}};
  scene.membrane = {{{1, 4, 5}, {{{0, 0}, {1, 0}, {1, 1}}}, 100, 100, 10}};
  scene.bending = {{{0, 1, 2, kNoIndex}, {1, -2, 1, 0}, 0, 1}};
  scene.anchors = {{.particle = 2, .point = {2, 0, 0}, .max_distance = 1}};
  scene.seams = {{.a = 2, .b = 3}};
  scene.sliders = {{.particle = 3, .first = 0, .last = 1, .friction = 0.2}};
  scene.rail_particles = {4, 5};
  scene.surface = {{1, 2, 4}, {2, 5, 4}};
  scene.air.triangles = {{0, 1, 2}};
  scene.air.drag = scene.air.ram = 1;
  scene.pressures = {{.pressure = 2, .triangles = {1}}};
  return scene;
}

/// 4 x 4, woven.
SceneDescription sheet() {
  SceneDescription scene;
  for (std::uint32_t i = 0; i < 16; ++i) {
    scene.positions.push_back({0.1 * (i / 4), 0, 0.1 * (i % 4)});
    if (i % 4 > 0) scene.constraints.push_back({i - 1, i, 0.1});
    if (i >= 4) scene.constraints.push_back({i - 4, i, 0.1});
  }
  scene.masses.assign(16, 0.01);
  scene.fixed = {0, 3};
  scene.positions.push_back({0.15, -0.2, 0.15});
  scene.masses.push_back(0.1);
  scene.radii.assign(17, 0);
  scene.spheres = {16};
  scene.radii[16] = 0.1;
  return scene;
}

struct Kind {
  bool has_everything;
  Settings settings;
};

Kind kind_of(std::size_t kind) {
  Settings s = brief_settings();
  switch (kind % kSavedCloths) {
    case 0:
      s.solver = Solver::small_steps;
      return {true, s};
    case 1:
      s.solver = Solver::small_steps, s.backend = Backend::reference;
      return {true, s};
    case 2:
      s.solver = Solver::yarn;
      return {false, s};
    case 3:
      s.solver = Solver::direct;
      return {false, s};
    case 4:
      s.solver = Solver::gauss_seidel;
      return {false, s};
    case 5:
      s.solver = Solver::gauss_seidel, s.backend = Backend::reference;
      return {false, s};
    case 6:
      s.solver = Solver::small_steps, s.sleep = true, s.scheme = Scheme::implicit;
      return {true, s};
    default:
      return {false, s};
  }
}

void add_bodies(Cloth& cloth) {
  for (const ShapeDescription& description : test::shapes_of_size(0.3)) {
    check(static_cast<bool>(cloth.add_body({.shape = build_shape(description).value(),
                                            .pose = {{1, -0.2, 0}, {0.1, 0.2, 0.3, 1}}})),
          "a body is added");
  }
}

}  // namespace

Cloth saved_cloth(std::size_t kind) {
  const auto [has_everything, settings] = kind_of(kind);
  auto model = build_model(has_everything ? with_everything() : sheet());
  check(static_cast<bool>(model), "the scene makes a model");
  auto cloth = Cloth::create(model.value(), settings);
  check(static_cast<bool>(cloth), cloth ? "" : cloth.error());
  return std::move(cloth).value();
}

Cloth saved_cloth_on_its_way(std::size_t kind) {
  Cloth cloth = saved_cloth(kind);
  if (kind_of(kind).has_everything) add_bodies(cloth);
  for (int i = 0; i < 3; ++i) check(static_cast<bool>(cloth.step(0.01)), "it steps");
  check(static_cast<bool>(cloth.move_fixed(0, {0, 0.01, 0})), "its pin moves");
  check(static_cast<bool>(cloth.write_forces(std::vector<Vec3>(cloth.particle_count(), {0, 1, 0}))),
        "it feels forces");
  return cloth;
}

Bytes sealed_like(std::span<const std::byte> saved, std::span<const std::byte> content) {
  weft::Kind kind{{}, "forged", std::to_integer<std::uint32_t>(saved[8])};
  std::ranges::transform(saved.first(8), kind.mark.begin(),
                         [](std::byte b) { return static_cast<char>(b); });
  return seal(kind, content);
}

void use_loaded(Cloth& cloth, std::size_t kind) {
  const Bytes bytes = cloth.save_state();
  Cloth other = saved_cloth(kind);
  const auto loaded = other.load_state(bytes);
  check(static_cast<bool>(loaded), "what a loaded state is saved as is loaded");
  check(other.save_state() == bytes, "a state that is loaded is saved as the same bytes");
  step_twice(cloth);
  step_twice(other);
  check(cloth.state_hash() == other.state_hash(),
        "a loaded state goes on as the one it was saved from");
}

}  // namespace weft::fuzz
