/// The direct solver on what pulls or pushes only: ropes and contacts.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/solvers/direct/direct_solver.h"
#include "tests/support/clothes.h"
#include "tests/support/meshes.h"
#include "tests/support/motion.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_direct_direct_one_sided {
namespace {

Settings direct(Settings settings) {
  settings.solver = Solver::direct;
  return settings;
}

TEST_CASE("a slack rope lets its ends fly free, and so does a taut one inwards") {
  for (const double start : {0.2, 1.0}) {
    SceneDescription scene = free_rope(start);
    scene.velocities = {{2, 0, 0}, {-3, 0, 0}};
    Settings settings = direct(tight(1e-12));
    settings.velocity_correction = true;
    Cloth cloth = cloth_of(scene, settings);
    CHECK(step(cloth, 0.01).corrections == 0);
    CHECK(distance(cloth.velocity(0), {2, 0, 0}) == 0);
    CHECK(distance(cloth.velocity(1), {-3, 0, 0}) == 0);
  }
}

TEST_CASE("a rope runs taut and shares the momentum") {
  SceneDescription scene = free_rope(0.95);
  scene.velocities = {{0, 0, 0}, {10, 0, 0}};
  Settings settings = direct(tight(1e-12));
  settings.velocity_correction = true;
  Cloth cloth = cloth_of(scene, settings);
  CHECK(step(cloth, 0.01).status == Status::converged);
  CHECK(distance(cloth.position(0), cloth.position(1)) == doctest::Approx(1).epsilon(1e-12));
  CHECK(distance(cloth.velocity(0), {5, 0, 0}) < 1e-9);
  CHECK(distance(cloth.velocity(1), {5, 0, 0}) < 1e-9);
}

TEST_CASE("a rope's early pull is taken back") {
  Cloth cloth = cloth_of(early_pull(), direct(tight(1e-12)));
  CHECK(step(cloth, 0.01).status == Status::converged);
  CHECK(distance(cloth.position(2), {0.6, 0, 0}) < 1e-10);
  CHECK(distance(cloth.position(3), {1.6, 0, 0}) < 1e-10);
  CHECK(distance(cloth.position(4), {-0.35, 0, 0}) < 1e-10);
}

TEST_CASE("a sheet of bars and ropes holds both, and no rope pushes") {
  SceneDescription scene = scene_of("hang", 9);
  for (std::size_t i = 0; i < scene.constraints.size(); i += 2) {
    scene.constraints[i].kind = ConstraintKind::rope;
  }
  Cloth cloth = cloth_of(scene, direct(tight(1e-6)));
  for (int k = 0; k < 100; ++k) {
    REQUIRE(step(cloth, 0.005).status == Status::converged);
    REQUIRE(max_strain(scene, positions(cloth)) <= 1e-6 * (1 + 1e-6));
  }
}

/// A flat net with more ropes than it has room for: edges, diagonals and ropes over every other
/// particle.
SceneDescription redundant_net(double speed, Random& random) {
  constexpr std::uint32_t kRows = 3, kColumns = 5;
  Mesh mesh = grid(kRows, kColumns);
  add_diagonals(mesh, kRows, kColumns, ConstraintKind::rope);
  add_bending(mesh, kRows, kColumns, ConstraintKind::rope);
  SceneDescription scene;
  scene.gravity = {0, 0, 0};
  for (const Vec3& p : mesh.positions) {
    scene.positions.push_back(p);
    scene.velocities.push_back(random.in_box(speed));
    scene.masses.push_back(1);
  }
  for (const Link& link : mesh.links) {
    const double apart = distance(mesh.positions[link.a], mesh.positions[link.b]);
    scene.constraints.push_back({link.a, link.b, apart, ConstraintKind::rope});
  }
  return scene;
}

// Solutions far from where the net is satisfy all ropes as well.
TEST_CASE("redundant ropes bring in no energy") {
  Random random(1);
  for (int k = 0; k < 1000; ++k) {
    CAPTURE(k);
    Cloth cloth = cloth_of(redundant_net(5, random), direct(tight(1e-6)));
    const double before = cloth.energy().total();
    REQUIRE(step(cloth, 0.1).status == Status::converged);
    REQUIRE(cloth.energy().total() <= before);
  }
}

TEST_CASE("scenes with contacts converge, none deeper than the tolerance") {
  for (const Backend backend : kBackends) {
    for (const char* name : {"hang_sphere", "sphere_drop"}) {
      for (const bool velocity_correction : {false, true}) {
        CAPTURE(std::string(name));
        CAPTURE(velocity_correction);
        const SceneDescription scene = scene_of(name, 13);
        Settings settings = direct(on(backend));
        settings.velocity_correction = velocity_correction;
        Cloth cloth = cloth_of(scene, settings);
        int contacts = 0;
        for (int k = 0; k < 200; ++k) {
          const StepReport report = step(cloth, 0.01);
          REQUIRE(report.status == Status::converged);
          REQUIRE(report.max_strain <= 0.01);
          REQUIRE(report.max_penetration <= 1e-4);
          contacts = std::max(contacts, report.contacts);
        }
        CHECK(contacts >= 5);
      }
    }
  }
}

TEST_CASE("a sphere falls on a free sheet: momentum is kept to rounding") {
  SceneDescription scene = drifting_sheet(9, 4);
  const auto sphere = static_cast<std::uint32_t>(scene.positions.size());
  scene.positions.push_back({0.4, 0.17, 0.41});
  scene.velocities.push_back({0.3, -5, 0.1});
  scene.masses.push_back(20);
  scene.spheres = {sphere};
  scene.radii.assign(scene.positions.size(), 0.01);
  scene.radii[sphere] = 0.15;
  const Vec3 before = momentum(scene.masses, scene.velocities);
  Settings settings = direct(tight(1e-4));
  settings.velocity_correction = true;
  Cloth cloth = cloth_of(scene, settings);
  int contacts = 0;
  for (int k = 0; k < 40; ++k) {
    const StepReport report = step(cloth, 0.0025);
    REQUIRE(report.status == Status::converged);
    REQUIRE(max_penetration(scene, positions(cloth)) <= 1e-4 * (1 + 1e-9));
    contacts = std::max(contacts, report.contacts);
  }
  CHECK(contacts > 3);
  CHECK(distance(momentum(scene.masses, velocities(cloth)), before) <= 1e-9 * length(before));
}

TEST_CASE("spheres collide with each other and with what is fixed") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0.01, 1.2, 0}, {0, 2.4, 0.01}, {0.3, 3.3, 0}};
  scene.velocities.assign(4, {0, -3, 0});
  scene.masses = {1, 1, 2, 0.1};
  scene.fixed = {0};
  scene.radii = {0.5, 0.5, 0.5, 0.1};
  scene.spheres = {1, 2};
  scene.constraints = {{2, 3, distance(scene.positions[2], scene.positions[3])}};
  Settings settings = direct(tight(1e-6));
  settings.velocity_correction = true;
  Cloth cloth = cloth_of(scene, settings);
  bool touched = false;
  for (int k = 0; k < 200; ++k) {
    const StepReport report = step(cloth, 0.005);
    REQUIRE(report.status == Status::converged);
    REQUIRE(max_penetration(scene, positions(cloth)) <= 1e-6 * (1 + 1e-9));
    touched = touched || report.corrections > 2;
  }
  CHECK(touched);
}

/// Two spheres, one above and one below the middle of what lies in the plane y = 0, move towards
/// each other.
SceneDescription squeezed(SceneDescription scene, Vec3 middle, double speed) {
  scene.velocities.assign(scene.positions.size(), {0, 0, 0});
  for (const double side : {1.0, -1.0}) {
    scene.spheres.push_back(static_cast<std::uint32_t>(scene.positions.size()));
    scene.positions.push_back(middle + Vec3{0.003 * side, 0.18 * side, 0.002});
    scene.velocities.push_back({0, -side * speed, 0});
    scene.masses.push_back(side > 0 ? 5 : 3);
  }
  scene.radii.assign(scene.positions.size(), 0.01);
  for (const std::uint32_t sphere : scene.spheres) scene.radii[sphere] = 0.15;
  scene.gravity = {0, 0, 0};
  return scene;
}

TEST_CASE("two spheres squeeze what is between them") {
  SceneDescription particle;
  particle.positions = {{0, 0, 0}};
  particle.masses = {1};
  const SceneDescription scenes[]{squeezed(particle, {0, 0, 0}, 1),
                                  squeezed(drifting_sheet(7, 2), {0.3, 0, 0.3}, 1)};
  for (const SceneDescription& scene : scenes) {
    for (const Backend backend : kBackends) {
      Cloth cloth = cloth_of(scene, direct(on(backend, tight(1e-4))));
      const Vec3 before = momentum(scene.masses, scene.velocities);
      const double start = cloth.energy().total();
      double energy = start;
      std::int64_t most = 0;
      for (int k = 0; k < 60; ++k) {
        const StepReport report = step(cloth, 0.005);
        REQUIRE(report.status == Status::converged);
        REQUIRE(max_penetration(scene, positions(cloth)) <= 1e-4 * (1 + 1e-6));
        REQUIRE(max_strain(scene, positions(cloth)) <= 1e-4 * (1 + 1e-6));
        CHECK(cloth.energy().total() <= energy + 1e-3);
        energy = cloth.energy().total();
        most = std::max(most, report.iterations);
      }
      CHECK(most <= 5);
      CHECK(energy < 0.1 * start);
      CHECK(distance(momentum(scene.masses, velocities(cloth)), before) <= 1e-9 * length(before));
    }
  }
}

/// A particle on a bar that flies into two spheres, after one solve.
Vec3 held_by_two(bool deeper_first) {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0.6, -0.8, 0}, {-0.2, 0.15, 0}, {0.13, 0.2, 0}};
  scene.velocities.assign(4, {0, 0, 0});
  scene.velocities[0] = {0, 3, 0};
  if (deeper_first) std::swap(scene.positions[2], scene.positions[3]);
  scene.masses = {1, 1, 1, 1};
  scene.fixed = {1};
  scene.constraints = {{0, 1, 1}};
  scene.spheres = {2, 3};
  scene.radii = {0.2, 0, 0.05, 0.05};
  scene.gravity = {0, 0, 0};
  Cloth cloth = cloth_of(scene, {.substeps = 1, .iterations = 1, .solver = Solver::direct});
  CHECK(step(cloth, 0.01).contacts == 2);
  return cloth.position(0);
}

TEST_CASE("of two contacts at a particle the deeper one holds it, whichever is first") {
  CHECK(distance(held_by_two(true), held_by_two(false)) < 1e-12);
}

// Solved for together with the bar, the contact would have to pull: it is let go, and the bar is
// solved for without it.
TEST_CASE("a matrix made with a contact does not serve when that has let go") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {1.3, 0.4, 0}};
  scene.velocities = {{0, 0, 0}, {3, -1, 0}, {0, 0, 0}};
  scene.masses = {1, 1, 1};
  scene.fixed = {0, 2};
  scene.constraints = {{0, 1, 1}};
  scene.spheres = {2};
  scene.radii = {0, 0, 0.5};
  const auto model = model_of(scene);
  const simd::Table& table = simd::table(simd::best_isa());
  kernels::Vectors x = model->initial_position, v = model->initial_velocity;
  SphereContacts contacts = make_sphere_contacts(*model);
  find_contacts(*model, table, x.view(), contacts);
  REQUIRE(contacts.count() == 1);
  Team team;
  DirectSolver solver(*model, direct(tight(1e-9)), table);
  const auto result = solver.correct_velocities(
      {.x = x.view(), .v = v.view(), .contacts = contacts, .max_iterations = 1000}, team);
  CHECK(result.converged);
  CHECK(result.iterations == 2);
  const kernels::Vector left = v[model->ordering.slot_of[1]];
  CHECK(kernels::length(left - kernels::Vector{0, -1, 0}) < 1e-9);
}

}  // namespace
}  // namespace weft::test::engine_solvers_direct_direct_one_sided
