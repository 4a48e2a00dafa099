/// Rings: their gap, their mass, and cloth on them, on both backends.
#include <doctest/doctest.h>
#include <weft/body.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "engine/bodies/body_shape.h"
#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/free_body.h"
#include "tests/support/random.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_bodies_torus {
namespace {

using kernels::Vector;

constexpr double kG = 10;  // m/s^2
constexpr double kPi = std::numbers::pi;
constexpr int kRates[] = {30, 60, 240};

Settings small_steps(Backend backend) {
  return {.solver = Solver::small_steps, .backend = backend, .threads = 1};
}

/// Level, around the origin, so wide and of so many particles a side.
SceneDescription sheet(std::uint32_t size, double width, double height) {
  MeshDescription mesh = quads(size);
  const double spacing = width / (size - 1);
  for (Vec3& v : mesh.positions) v = {spacing * v.x - width / 2, height, spacing * v.y - width / 2};
  mesh.material = find_material("cotton").value();
  return made(mesh).scene;
}

double mass_of(const SceneDescription& scene) {
  return std::accumulate(scene.masses.begin(), scene.masses.end(), 0.0);
}

TEST_CASE("the gap of a torus is the distance from its circle, less its minor radius") {
  const Torus torus{{0.1, 0.2, -0.1}, {1, 2, -0.5}, 0.3, 0.08};
  const auto shape = shape_of(torus);
  const Vec3 w = (1 / length(torus.axis)) * torus.axis;
  const Vec3 across = cross(w, {0, 0, 1}), u = (1 / length(across)) * across, v = cross(w, u);
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Vec3 at = torus.centre + random.in_box(0.5);
    double least = std::numeric_limits<double>::infinity();
    constexpr int kPlaces = 4000;
    for (int k = 0; k < kPlaces; ++k) {
      const double angle = 2 * kPi * k / kPlaces;
      least = std::min(least, distance(at, torus.centre + 0.3 * std::cos(angle) * u +
                                               0.3 * std::sin(angle) * v));
    }
    const reference::Gap gap = shape->form()->gap({at.x, at.y, at.z});
    CHECK(gap.gap == doctest::Approx(least - 0.08).epsilon(1e-4));
    const Vector foot = Vector{at.x, at.y, at.z} - gap.gap * gap.normal;
    CHECK(std::abs(shape->form()->gap(foot).gap) < 1e-12);
  }
  const reference::Gap middle = shape->form()->gap({0.1, 0.2, -0.1});
  CHECK(middle.gap == doctest::Approx(0.22));
  CHECK(length(middle.normal) == doctest::Approx(1));
}

TEST_CASE("shapes of tori that are none are refused") {
  const auto refusal = [](const Torus& torus) { return build_shape(torus).error(); };
  CHECK(refusal({.axis = {0, 0, 0}, .major = 1, .minor = 0.1}) ==
        "axis: has no direction (0, 0, 0)");
  CHECK(refusal({.major = 0, .minor = 0.1}) == "major: must be finite and greater than 0 (0)");
  CHECK(refusal({.major = 1, .minor = -1}) == "minor: must be finite and greater than 0 (-1)");
  CHECK(refusal({.major = 1, .minor = 1}) ==
        "minor: must be from 1/10000 of major to less than that, 1 (1)");
  CHECK(refusal({.major = 1, .minor = 1e-6}).starts_with("minor: must be from 1/10000"));
  CHECK(refusal({.centre = {0, NAN, 0}, .major = 1, .minor = 0.1}).starts_with("centre: must be"));
}

/// By midpoints of many small boxes.
TEST_CASE("mass and inertia of a torus are those of a full one") {
  const Torus torus{{0.1, -0.2, 0.3}, {0, 0, 2}, 0.3, 0.1};
  const BodyMass mass = weft::mass_of(*shape_of(torus), 1000).value();
  CHECK(mass.mass == doctest::Approx(1000 * 2 * kPi * kPi * 0.3 * 0.01));
  CHECK(distance(mass.centre, torus.centre) < 1e-12);
  constexpr int kSteps = 160;
  double volume = 0, about_axis = 0, about_x = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double x = -0.4 + 0.8 * (i + 0.5) / kSteps, y = -0.4 + 0.8 * (j + 0.5) / kSteps;
      const double aside = std::hypot(x, y) - 0.3,
                   half = std::sqrt(std::max(0., 0.01 - aside * aside));
      volume += 2 * half;
      about_axis += 2 * half * (x * x + y * y);
      about_x += 2 * half * (y * y + half * half / 3);
    }
  }
  CHECK(mass.inertia[2] == doctest::Approx(mass.mass * about_axis / volume).epsilon(2e-3));
  CHECK(mass.inertia[0] == doctest::Approx(mass.mass * about_x / volume).epsilon(2e-3));
  CHECK(mass.inertia[1] == doctest::Approx(mass.inertia[0]));
  for (std::size_t k = 3; k < 6; ++k) CHECK(std::abs(mass.inertia[k]) < 1e-9);
}

/// A ring that lies, of a major radius of 0.2 m and a minor one of 0.06.
Torus ring(Vec3 axis = {0, 1, 0}) { return {.axis = axis, .major = 0.2, .minor = 0.06}; }

/// m, of a particle beside the ring at a pose.
double gap_of(const Torus& torus, const Pose& pose, Vec3 x) {
  const Rotation& r = pose.rotation;
  const Vec3 y = turned({-r.x, -r.y, -r.z, r.w}, x - pose.position);
  return shape_of(torus)->form()->gap({y.x, y.y, y.z}).gap;
}

TEST_CASE("a sheet that is draped over a torus comes to rest on it with its weight") {
  const Backend backend = each_backend();
  SceneDescription scene = sheet(20, 0.7, 0.08);
  scene.friction = 0.5;
  for (const int rate : kRates) {
    CAPTURE(rate);
    Cloth cloth = cloth_of(scene, small_steps(backend));
    const auto id = add(cloth, {.shape = shape_of(ring()), .friction = 0.5});
    for (int i = 0; i < 6 * rate; ++i) {
      const StepReport report = step(cloth, 1.0 / rate);
      CHECK(report.max_penetration < 1e-4);
    }
    const std::vector<Vec3> before = positions(cloth);
    Vec3 force{};
    for (int i = 0; i < rate / 2; ++i) {
      CHECK(step(cloth, 1.0 / rate).status == Status::converged);
      force = force + (1.0 / (rate / 2)) * cloth.body_load(id).value().force;
    }
    CHECK(force.y == doctest::Approx(-mass_of(scene) * kG).epsilon(0.01));
    CHECK(std::abs(force.x) < 0.01 * mass_of(scene) * kG);
    CHECK(largest_distance(positions(cloth), before) < 1e-3);
    double lowest = 1;
    for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
      CHECK(gap_of(ring(), {}, cloth.position(i)) > 1e-3 - 1e-5);
      if (length(cloth.position(i)) < 0.1) lowest = std::min(lowest, cloth.position(i).y);
    }
    CHECK(lowest < 0.07);  // it hangs in the hole
  }
}

TEST_CASE("a torus that moves and turns pushes particles, and none passes through it") {
  const Backend backend = each_backend();
  for (const int rate : kRates) {
    CAPTURE(rate);
    SceneDescription scene;
    for (int i = -2; i <= 2; ++i) {
      scene.positions.push_back({0.2, 0.004 * i, 0.3 + 0.01 * i});
      scene.masses.push_back(0.01);
    }
    scene.gravity = {};
    Cloth cloth = cloth_of(scene, small_steps(backend));
    const auto id = add(cloth, {.shape = shape_of(ring({1, 0, 0})), .friction = 0});
    // It falls on them sideways, at 30 m/s, and turns about its axis.
    constexpr double kSpeed = 30;
    REQUIRE(cloth.place_body(id, {.position = {0.2, 0, -0.1}}));
    REQUIRE(cloth.move_body(id, {{0.2, 0, -0.1 + kSpeed / rate}, turn({1, 0, 0}, 1)}));
    const StepReport report = step(cloth, 1.0 / rate);
    CHECK(report.max_penetration < 1e-4);
    double momentum = 0;
    for (std::uint32_t i = 0; i < 5; ++i) {
      // The near side of its tube was before them, and is so still.
      CHECK(cloth.position(i).z > -0.1 + kSpeed / rate + 0.2);
      momentum += 0.01 * cloth.velocity(i).z;
    }
    CHECK(-rate * momentum == doctest::Approx(cloth.body_load(id).value().force.z).epsilon(1e-3));
  }
}

TEST_CASE(
    "friction of a torus that spins about its axis drives a particle as fast as its surface") {
  const Backend backend = each_backend();
  SceneDescription scene;
  scene.positions = {{0.2, 0.061, 0}};
  scene.masses = {0.01};
  scene.friction = 0.5;
  Cloth cloth = cloth_of(scene, small_steps(backend));
  const auto id = add(cloth, {.shape = shape_of(ring()), .friction = 0.5});
  REQUIRE(cloth.move_body(id, {.rotation = turn({0, 1, 0}, 50.0 / 600)}));
  step(cloth, 1.0 / 600);
  // 0.5 g for 1/600 s
  CHECK(cloth.velocity(0).z == doctest::Approx(-0.5 * kG / 600).epsilon(0.02));
}

/// Of 4 mm, between particles that are 7 cm apart.
TEST_CASE("a thin torus does not fall through coarse cloth, nor coarse cloth through it") {
  const Backend backend = each_backend();
  for (const int rate : kRates) {
    CAPTURE(rate);
    SceneDescription scene = sheet(8, 0.5, 0.05);
    Cloth cloth = cloth_of(scene, small_steps(backend));
    add(cloth, {.shape = shape_of(Torus{.major = 0.15, .minor = 2e-3}), .friction = 0.5});
    for (int i = 0; i < 2 * rate; ++i) step(cloth, 1.0 / rate);
    double mean = 0;
    for (const Vec3 x : positions(cloth)) mean += x.y / 64;
    CHECK(mean > -0.2);
    CHECK(step(cloth, 1.0 / rate).intersecting == 0);
  }
}

TEST_CASE("a torus with a mass falls onto a sheet that holds it, which bears its weight") {
  const Backend backend = each_backend();
  SceneDescription scene = sheet(13, 0.6, 0);
  scene.fixed = {0, 12, 156, 168};
  scene.friction = 0.3;
  Cloth cloth = cloth_of(scene, small_steps(backend));
  const Free body =
      add_free(cloth, Torus{.major = 0.12, .minor = 0.04}, 0.3, {.position = {0, 0.05, 0}});
  run(cloth, 1. / 60, 240);
  double low = 1, high = -1;
  for (int i = 0; i < 60; ++i) {
    run(cloth, 1. / 60, 1);
    const double y = body.centre(cloth).y;
    low = std::min(low, y);
    high = std::max(high, y);
  }
  CHECK(low > -0.3);
  CHECK(high - low < 5e-3);
}

}  // namespace
}  // namespace weft::test::engine_bodies_torus
