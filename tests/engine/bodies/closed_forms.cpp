/// Cloth and particles beside bodies against closed forms, on both backends.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_bodies_closed_forms {
namespace {

constexpr double kG = 10;  // m/s^2

Settings small_steps(Backend backend) {
  return {.solver = Solver::small_steps, .backend = backend, .threads = 1};
}

/// A square of fabric in the plane through the origin that is turned about z by the angle.
MeshCloth sheet_on_incline(std::uint32_t size, double angle, double height) {
  MeshDescription mesh = quads(size);
  const double spacing = 0.5 / (size - 1);
  for (Vec3& v : mesh.positions) {
    const double along = spacing * v.x, across = spacing * v.y;
    v = {std::cos(angle) * along - std::sin(angle) * height,
         std::sin(angle) * along + std::cos(angle) * height, across};
  }
  mesh.material = find_material("cotton").value();
  return made(mesh);
}

/// m, down the incline, in the mean.
double descent(const Cloth& cloth, const std::vector<Vec3>& from, double angle) {
  double sum = 0;
  for (std::uint32_t i = 0; i < from.size(); ++i) {
    const Vec3 x = cloth.position(i);
    sum -= (x.x - from[i].x) * std::cos(angle) + (x.y - from[i].y) * std::sin(angle);
  }
  return sum / static_cast<double>(from.size());
}

struct Incline {
  double angle, friction;
  Backend backend;
  std::uint32_t size;
};

/// Lets a sheet go that lies on an incline, for a time, in steps of 1/60 s. Returns its descent.
double slide(const Incline& incline, double time) {
  const MeshCloth sheet = sheet_on_incline(incline.size, incline.angle, 1e-3);
  SceneDescription scene = sheet.scene;
  scene.friction = incline.friction;
  Cloth cloth = cloth_of(scene, small_steps(incline.backend));
  const Vec3 up{-std::sin(incline.angle), std::cos(incline.angle), 0};
  add(cloth, {.shape = shape_of(Plane{.normal = up}), .friction = incline.friction});
  const std::vector<Vec3> start = positions(cloth);
  const int steps = static_cast<int>(std::lround(60 * time));
  for (int i = 0; i < steps; ++i) {
    const StepReport report = step(cloth, 1.0 / 60);
    CHECK(report.status == Status::converged);
    CHECK(report.max_penetration < 1e-5);
  }
  return descent(cloth, start, incline.angle);
}

constexpr double kDegree = std::numbers::pi / 180;

TEST_CASE("a sheet on an incline rests below the angle of friction, and slides by its law above") {
  const Backend backend = each_backend();
  for (const std::uint32_t size : {5u, 12u, 20u}) {
    CAPTURE(size);
    CHECK(std::abs(slide({16 * kDegree, 0.3, backend, size}, 1)) < 1e-4);
    const double angle = 25 * kDegree;
    for (const double friction : {0.0, 0.1, 0.3}) {
      CAPTURE(friction);
      const double a = kG * (std::sin(angle) - friction * std::cos(angle));
      CHECK(slide({angle, friction, backend, size}, 1) == doctest::Approx(a / 2).epsilon(0.01));
    }
  }
}

TEST_CASE("what lies on a plane weighs on it, and the plane bears it") {
  const MeshCloth sheet = sheet_on_incline(12, 0, 1e-3);
  Cloth cloth = cloth_of(sheet.scene, small_steps(each_backend()));
  const auto id = add(cloth, {.shape = shape_of(Plane{})});
  run(cloth, 1.0 / 60, 60);
  double mass = 0;
  for (const double m : sheet.scene.masses) mass += m;
  const BodyLoad load = cloth.body_load(id).value();
  CHECK(load.force.y == doctest::Approx(-mass * kG).epsilon(1e-4));
  CHECK(std::abs(load.force.x) < 1e-4 * mass * kG);
  CHECK(cloth.body_contacts().size() == sheet.scene.positions.size());
  const double fastest = [&] {
    double most = 0;
    for (const Vec3 v : velocities(cloth)) most = std::max(most, length(v));
    return most;
  }();
  CHECK(fastest < 1e-4);
}

TEST_CASE("contacts of the last step are known when their body is gone") {
  const MeshCloth sheet = sheet_on_incline(5, 0, 1e-3);
  Cloth cloth = cloth_of(sheet.scene, small_steps(each_backend()));
  const auto id =
      add(cloth, {.shape = shape_of(box({2, 0.2, 2})), .pose = {.position = {0, -0.1, 0}}});
  run(cloth, 1.0 / 60, 10);
  REQUIRE(cloth.remove_body(id));
  const std::vector<BodyContact> contacts = cloth.body_contacts();
  CHECK(contacts.size() == sheet.scene.positions.size());
  for (const BodyContact& contact : contacts) CHECK(contact.normal.y == 1);
  CHECK_FALSE(cloth.body_load(id));
}

TEST_CASE("a cloth that takes over another one's state takes its bodies over") {
  const SceneDescription scene = scene_of("hang", 12);
  const auto model = model_of(scene);
  const Settings exact{.tolerance = 1e-4, .threads = 1};
  Cloth from = Cloth::create(model, exact).value(), to = Cloth::create(model, exact).value();
  REQUIRE(to.settings().solver == Solver::yarn);
  add(from, {.shape = shape_of(Plane{{0, 1, 0}, -0.3})});
  run(from, 1.0 / 60, 10);
  REQUIRE(to.copy_state(from));
  CHECK(to.settings().solver == Solver::small_steps);
  run(from, 1.0 / 60, 30);
  run(to, 1.0 / 60, 30);
  CHECK(to.body_contacts().size() > 0);
  CHECK(to.state_hash() == from.state_hash());
  Cloth fixed = Cloth::create(model, {.solver = Solver::yarn, .threads = 1}).value();
  CHECK(fixed.copy_state(from).error() == "body: needs solver small_steps (yarn)");
}

TEST_CASE("a plane that moves takes a sheet along, by friction, and up to what that can do") {
  const Backend backend = each_backend();
  const MeshCloth sheet = sheet_on_incline(8, 0, 1e-3);
  SceneDescription scene = sheet.scene;
  scene.friction = 0.3;
  Cloth cloth = cloth_of(scene, small_steps(backend));
  const auto id = add(cloth, {.shape = shape_of(Plane{}), .friction = 0.3});
  const std::vector<Vec3> start = positions(cloth);
  constexpr double kSpeed = 2, kTime = 1;
  for (int i = 1; i <= 60; ++i) {
    REQUIRE(cloth.move_body(id, {.position = {-kSpeed * i / 60, 0, 0}}));
    step(cloth, 1.0 / 60);
  }
  const double a = 0.3 * kG, reaches = kSpeed / a;
  const double way = a * reaches * reaches / 2 + kSpeed * (kTime - reaches);
  CHECK(descent(cloth, start, 0) == doctest::Approx(way).epsilon(0.01));
}

constexpr double kSpacing = 0.02, kBead = 1e-3;  // m, kg

/// A rope of beads over a drum, with a load at each end.
SceneDescription rope_over_drum(double radius, int half, double load, double other_load) {
  SceneDescription scene;
  const double quarter = std::numbers::pi * radius / 2;
  for (int i = -half; i <= half; ++i) {
    const double s = i * kSpacing;
    const double over = std::abs(s) - quarter, angle = s / radius;
    Vec3 x{radius * std::sin(angle), radius * std::cos(angle), 0};
    if (over > 0) x = {std::copysign(radius, s), -over, 0};
    scene.positions.push_back(x);
    scene.masses.push_back(kBead);
  }
  const auto last = static_cast<std::uint32_t>(2 * half);
  for (std::uint32_t i = 0; i < last; ++i) {
    const double l = length(scene.positions[i + 1] - scene.positions[i]);
    scene.constraints.push_back({.a = i, .b = i + 1, .rest_length = l, .compliance = 1e-5});
  }
  scene.masses.front() = load;
  scene.masses.back() = other_load;
  scene.damping.motion = 20;  // 1/s: the rope is let go without tension
  return scene;
}

/// The largest load on one side of a drum that friction holds against the load on the other. With
/// the tension T and the weight w per length, at the angle p from the top, where the rope is about
/// to slide T' = mu T + w r (mu cos p - sin p), so that T = C e^(mu p) + A cos p + B sin p.
double most_load(double radius, int half, double load, double friction) {
  const double w = kBead * kG / kSpacing, mu = friction;
  const double b = 2 * mu * w * radius / (1 + mu * mu);
  const double hangs = w * (half * kSpacing - std::numbers::pi * radius / 2);
  const double tension = load * kG + hangs;
  return ((tension + b) * std::exp(mu * std::numbers::pi) + b - hangs) / kG;
}

/// m, by which the heavier end comes down in half a second, after a second.
double fall_over_drum(Backend backend, double share_of_most) {
  constexpr double kRadius = 0.1, kLoad = 0.05, kFriction = 0.3;
  constexpr int kHalf = 25;
  SceneDescription scene = rope_over_drum(
      kRadius, kHalf, kLoad, share_of_most * most_load(kRadius, kHalf, kLoad, kFriction));
  scene.friction = kFriction;
  Cloth cloth = cloth_of(scene, small_steps(backend));
  add(cloth, {.shape = shape_of(Capsule{{0, 0, -1}, {0, 0, 1}, kRadius, kRadius}),
              .thickness = 0,
              .friction = kFriction});
  const auto last = static_cast<std::uint32_t>(scene.positions.size() - 1);
  run(cloth, 1.0 / 60, 60);
  const double from = cloth.position(last).y;
  run(cloth, 1.0 / 60, 30);
  return from - cloth.position(last).y;
}

TEST_CASE("a rope over a drum holds what the capstan equation says, and no more") {
  const Backend backend = each_backend();
  CHECK(fall_over_drum(backend, 0.98) < 1e-4);
  CHECK(fall_over_drum(backend, 1.02) > 2e-3);
}

TEST_CASE("what a body appears around comes out by 2 m/s") {
  const Backend backend = each_backend();
  const std::array<ShapeDescription, 3> shapes{Ball{.radius = 0.2}, box({0.4, 0.4, 0.4}),
                                               box_mesh({0.4, 0.4, 0.4}, 3)};
  for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
    CAPTURE(shape);
    SceneDescription scene;
    scene.gravity = {};
    for (int i = -2; i <= 2; ++i) {
      scene.positions.push_back({0.02 * i, 0.03, 0.01 * i});
      scene.masses.push_back(0.01);
    }
    Cloth cloth = cloth_of(scene, small_steps(backend));
    add(cloth, {.shape = shape_of(shapes[shape])});
    run(cloth, 1.0 / 60, 1);
    for (std::uint32_t i = 0; i < 5; ++i) {
      const double speed = 60 * length(cloth.position(i) - scene.positions[i]);
      CHECK(speed == doctest::Approx(2).epsilon(1e-3));
    }
  }
}

void push_particles(Backend backend, const ShapeDescription& shape) {
  SceneDescription scene;
  for (int i = -2; i <= 2; ++i) {
    scene.positions.push_back({0.5, 0.004 * i, 0.005 * i});
    scene.masses.push_back(0.01);
  }
  scene.gravity = {0, 0, 0};
  Cloth cloth = cloth_of(scene, small_steps(backend));
  const auto id = add(cloth, {.shape = shape_of(shape), .pose = {.position = {-1, 0, 0}}});
  constexpr double kSpeed = 100;
  REQUIRE(cloth.move_body(id, {.position = {-1 + kSpeed / 60, 0, 0}}));
  const StepReport report = step(cloth, 1.0 / 60);
  CHECK(report.max_penetration < 1e-5);
  for (const Vec3 x : positions(cloth)) CHECK(x.x > -1 + kSpeed / 60);
  double momentum = 0;
  for (std::uint32_t i = 0; i < 5; ++i) momentum += 0.01 * cloth.velocity(i).x;
  CHECK(-60 * momentum == doctest::Approx(cloth.body_load(id).value().force.x).epsilon(1e-4));
}

TEST_CASE("a fast body takes particles along, and nothing passes through it") {
  const Backend backend = each_backend();
  SUBCASE("a ball") { push_particles(backend, Ball{.radius = 0.05}); }
  SUBCASE("a capsule") { push_particles(backend, Capsule{{0, 0, -0.2}, {0, 0, 0.2}, 0.05, 0.03}); }
  SUBCASE("a box") { push_particles(backend, box({0.05, 0.2, 0.2})); }
}

void press_on(Backend backend, const ShapeDescription& shape, double height) {
  SceneDescription scene;
  scene.positions = {{0, height - 1e-9, 0}};  // under the surface, by rounding
  scene.masses = {0.01};
  scene.gravity = {0, -5000, 0};  // in a substep it would come out on the other side
  Cloth cloth = cloth_of(scene, small_steps(backend));
  add(cloth, {.shape = shape_of(shape)});
  run(cloth, 1.0 / 60, 10);
  CHECK(cloth.position(0).y > height - 1e-5);
}

TEST_CASE("what is pressed onto a thin body does not leave it by the other side") {
  const Backend backend = each_backend();
  SUBCASE("a plate") { press_on(backend, box({1, 0.01, 1}), 0.006); }
  SUBCASE("a ball") { press_on(backend, Ball{.radius = 0.01}, 0.011); }
}

TEST_CASE("cloth that a body appears in comes out slowly, and is at rest then") {
  const MeshCloth sheet = sheet_on_incline(12, 0, 0.05);
  SceneDescription scene = sheet.scene;
  scene.gravity = {0, 0, 0};
  Cloth cloth = cloth_of(scene, small_steps(each_backend()));
  add(cloth, {.shape = shape_of(box({2, 0.2, 2})), .thickness = 0});
  double fastest = 0;
  std::vector<Vec3> before = positions(cloth);
  for (int i = 0; i < 60; ++i) {
    const StepReport report = step(cloth, 1.0 / 60);
    CHECK(report.energy_lost > -1e-6);
    const std::vector<Vec3> now = positions(cloth);
    fastest = std::max(fastest, 60 * largest_distance(before, now));
    before = now;
  }
  CHECK(fastest < 2.02);
  CHECK(step(cloth, 1.0 / 60).max_penetration < 1e-6);
  for (std::uint32_t i = 0; i < before.size(); ++i) {
    CHECK(before[i].y == doctest::Approx(0.1).epsilon(1e-5));
    CHECK(length(cloth.velocity(i)) < 1e-4);
  }
}

TEST_CASE("friction of a drum that spins drives a particle as fast as its surface") {
  const Backend backend = each_backend();
  SceneDescription scene;
  scene.positions = {{0, 0.101, 0}};
  scene.masses = {0.01};
  scene.friction = 0.5;
  Cloth cloth = cloth_of(scene, small_steps(backend));
  const auto id =
      add(cloth, {.shape = shape_of(Capsule{{0, 0, -1}, {0, 0, 1}, 0.1, 0.1}), .friction = 0.5});
  const double spin = 50, angle = spin / 600;
  REQUIRE(cloth.move_body(id, {.rotation = {0, 0, -std::sin(angle / 2), std::cos(angle / 2)}}));
  step(cloth, 1.0 / 600);
  // 0.5 g for 1/600 s
  CHECK(cloth.velocity(0).x == doctest::Approx(0.5 * kG / 600).epsilon(0.02));
}

}  // namespace
}  // namespace weft::test::engine_bodies_closed_forms
