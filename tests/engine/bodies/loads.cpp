/// What bodies that move learn of the cloth: its momentum, whatever it touched before, and what
/// friction took.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_bodies_loads {
namespace {

constexpr double kG = 10;  // m/s^2
constexpr double kFriction = 0.3;

std::uint32_t add(Cloth& cloth, const ShapeDescription& shape) {
  return test::add(cloth, Body{.shape = shape_of(shape), .friction = kFriction});
}

/// Half a metre wide, level, at a height.
SceneDescription sheet(std::uint32_t size, double height) {
  MeshDescription mesh = quads(size);
  const double spacing = 0.5 / (size - 1);
  for (Vec3& v : mesh.positions) v = {spacing * v.x - 0.25, height, spacing * v.y - 0.25};
  mesh.material = find_material("cotton").value();
  SceneDescription scene = made(mesh).scene;
  scene.friction = kFriction;
  scene.air.density = 0;
  return scene;
}

Cloth cloth_in_substeps(const SceneDescription& scene, Backend backend, int substeps) {
  Settings settings{.solver = Solver::small_steps, .backend = backend, .threads = 1};
  settings.substeps = substeps;
  return cloth_of(scene, settings);
}

double mass_of(const SceneDescription& scene) {
  return std::accumulate(scene.masses.begin(), scene.masses.end(), 0.0);
}

Vec3 momentum(const Cloth& cloth, const SceneDescription& scene) {
  Vec3 sum{};
  for (std::uint32_t i = 0; i < scene.masses.size(); ++i)
    sum = sum + scene.masses[i] * cloth.velocity(i);
  return sum;
}

TEST_CASE("a plane that moves bears the weight of what lies on it") {
  const Backend backend = each_backend();
  const SceneDescription scene = sheet(8, 1e-3);
  for (const int substeps : {1, 2, 5}) {
    CAPTURE(substeps);
    Cloth cloth = cloth_in_substeps(scene, backend, substeps);
    const std::uint32_t plane = add(cloth, Plane{});
    Pose pose;
    for (int i = 0; i < 60; ++i) {
      pose.position.y += 0.5 / 60;
      REQUIRE(cloth.move_body(plane, pose));
      step(cloth, 1.0 / 60);
      if (i < 30) continue;
      CHECK(cloth.body_load(plane).value().force.y ==
            doctest::Approx(-mass_of(scene) * kG).epsilon(1e-4));
    }
  }
}

TEST_CASE("friction takes what a plane does that is drawn away under a sheet") {
  const Backend backend = each_backend();
  const SceneDescription scene = sheet(8, 1e-3);
  constexpr double kSpeed = 2;
  for (const int substeps : {1, 2, 5}) {
    CAPTURE(substeps);
    Cloth cloth = cloth_in_substeps(scene, backend, substeps);
    const std::uint32_t plane = add(cloth, Plane{});
    run(cloth, 1.0 / 60, 30);
    Pose pose;
    for (int i = 0; i < 20; ++i) {
      const double before = momentum(cloth, scene).x / mass_of(scene);
      pose.position.x += kSpeed / 60;
      REQUIRE(cloth.move_body(plane, pose));
      const StepReport report = step(cloth, 1.0 / 60);
      if (i == 0) continue;
      const double after = momentum(cloth, scene).x / mass_of(scene);
      const double pull = kFriction * mass_of(scene) * kG, slides = kSpeed - 0.5 * (before + after);
      CHECK(cloth.body_load(plane).value().force.x == doctest::Approx(-pull).epsilon(2e-3));
      CHECK(report.friction_work == doctest::Approx(pull * slides / 60).epsilon(0.01));
      CHECK(report.body_work == doctest::Approx(pull * kSpeed / 60).epsilon(2e-3));
    }
  }
}

TEST_CASE("friction takes the energy that a sheet loses as it slides down") {
  const Backend backend = each_backend();
  const double angle = 0.44, downhill = std::sin(angle);  // tan = 0.47
  const std::array<ShapeDescription, 2> shapes{Plane{}, box_mesh({8, 2, 8}, 43)};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (const int substeps : {1, 5, kAutomaticSubsteps}) {
      CAPTURE(i);
      CAPTURE(substeps);
      SceneDescription scene = sheet(8, i == 0 ? 1e-3 : 1 + 1e-3);
      const auto tilt = turn({0, 0, 1}, angle);
      for (Vec3& x : scene.positions) x = turned(tilt, x);
      Cloth cloth = cloth_in_substeps(scene, backend, substeps);
      test::add(
          cloth,
          Body{.shape = shape_of(shapes[i]), .pose = {.rotation = tilt}, .friction = kFriction});
      const double before = cloth.energy().total();
      double taken = 0;
      for (int k = 0; k < 30; ++k) taken += step(cloth, 1.0 / 60).friction_work;
      const double acceleration = kG * (downhill - kFriction * std::cos(angle));
      const double way = acceleration / 8;
      CHECK(taken ==
            doctest::Approx(kFriction * std::cos(angle) * mass_of(scene) * kG * way).epsilon(0.02));
      CHECK(taken == doctest::Approx(before - cloth.energy().total()).epsilon(0.01));
    }
  }
}

/// A sheet falls on a body that moves to and fro and turns, and is gone in the end.
void check_balance(const ShapeDescription& shape, Backend backend, int substeps, double tolerance) {
  CAPTURE(substeps);
  const SceneDescription scene = sheet(10, 0.2);
  Cloth cloth = cloth_in_substeps(scene, backend, substeps);
  const std::uint32_t body = add(cloth, shape);
  Vec3 given{};
  constexpr double kDt = 1.0 / 60;
  constexpr int kFrames = 50, kFreeFrames = 12;
  for (int i = 1; i <= kFrames; ++i) {
    const double t = kDt * i;
    REQUIRE(cloth.move_body(body, {.position = {0.05 * std::sin(9 * t), 0.04 * std::sin(14 * t), 0},
                                   .rotation = turn({0, 1, 0}, t)}));
    step(cloth, kDt);
    given = given - kDt * cloth.body_load(body).value().force;
  }
  REQUIRE(cloth.remove_body(body));
  run(cloth, kDt, kFreeFrames);
  const double weight = mass_of(scene) * kG * kDt;
  CHECK(given.y > 0.3 * kFrames * weight);
  const Vec3 missing =
      given - Vec3{0, weight * (kFrames + kFreeFrames), 0} - momentum(cloth, scene);
  CHECK(length(missing) < tolerance * kFrames * weight);
}

TEST_CASE("what bodies give to the cloth is what its momentum changes by") {
  const Backend backend = each_backend();
  const std::array<ShapeDescription, 3> shapes{Ball{.radius = 0.15}, box({0.1, 0.15, 0.1}),
                                               box_mesh({0.2, 0.3, 0.2}, 2)};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    CAPTURE(i);
    for (const int substeps : {1, 2, 5, 30}) check_balance(shapes[i], backend, substeps, 1e-4);
    // Where substeps become longer or shorter BDF2 itself gains or loses some.
    check_balance(shapes[i], backend, kAutomaticSubsteps, 5e-3);
  }
}

}  // namespace
}  // namespace weft::test::engine_bodies_loads
