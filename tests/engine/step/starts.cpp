/// Starts that violate constraints are projected without adding velocity; pins that move drive the
/// cloth, pins that are placed elsewhere do not.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_starts {
namespace {

/// Both schemes, both backends, and the direct solver.
std::vector<Settings> all_settings(double tolerance) {
  std::vector<Settings> all;
  for (const Scheme scheme : {Scheme::paper, Scheme::rattle}) {
    for (int k = 0; k < 3; ++k) {
      Settings settings = tight(tolerance);
      settings.scheme = scheme;
      if (k == 0) settings.backend = Backend::reference;
      if (k == 2) settings.solver = Solver::direct;
      all.push_back(settings);
    }
  }
  return all;
}

std::string text(const Settings& settings) {
  return std::string(name(settings.scheme)) + " " + std::string(name(settings.backend)) + " " +
         std::string(name(settings.solver));
}

SceneDescription weightless(const char* scene, int size) {
  SceneDescription description = scene_of(scene, size);
  description.gravity = {0, 0, 0};
  return description;
}

TEST_CASE("a stretched start is put right and stays at rest") {
  SceneDescription scene = weightless("hang", 6);
  for (Vec3& p : scene.positions) p.x *= 1.3;
  for (const Settings& settings : all_settings(1e-5)) {
    CAPTURE(text(settings));
    Cloth cloth = cloth_of(scene, settings);
    const StepReport report = step(cloth, 0.01);
    CHECK(report.status == Status::converged);
    CHECK(report.max_strain <= 1e-5 * (1 + 1e-9));
    CHECK(cloth.energy().kinetic < 1e-6);  // 0.3 m in 0.01 s would be hundreds of joules
  }
}

TEST_CASE("so is a state that is written, but a violation within tolerance is left alone") {
  const SceneDescription scene = weightless("hang", 6);
  for (const Settings& settings : all_settings(1e-3)) {
    CAPTURE(text(settings));
    Cloth cloth = cloth_of(scene, settings);
    step(cloth, 0.01);
    std::vector<Vec3> stretched = scene.positions;
    for (Vec3& p : stretched) p.x *= 1.2;
    REQUIRE(cloth.write_positions(stretched));
    step(cloth, 0.01);
    CHECK(cloth.energy().kinetic < 1e-6);
  }
  Settings loose = tight(0.1);
  Cloth cloth = cloth_of(scene, loose);
  std::vector<Vec3> stretched = scene.positions;
  for (Vec3& p : stretched) p.x *= 1.05;
  REQUIRE(cloth.write_positions(stretched));
  step(cloth, 0.01);
  CHECK(largest_distance(positions(cloth), stretched) == 0);
}

TEST_CASE("what flies goes on flying: projecting changes positions alone") {
  SceneDescription scene = free_bar(1, 1);
  scene.positions[1].x = 1.5;
  scene.velocities = {{0, 3, 0}, {0, 3, 0}};
  for (const Settings& settings : all_settings(1e-6)) {
    CAPTURE(text(settings));
    Cloth cloth = cloth_of(scene, settings);
    step(cloth, 0.01);
    for (const std::uint32_t i : {0u, 1u}) CHECK(distance(cloth.velocity(i), {0, 3, 0}) < 1e-5);
    CHECK(distance(cloth.position(0), {0.25, 0.03, 0}) < 1e-5);
  }
}

TEST_CASE("a start inside a sphere is pushed out and stays at rest") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0.05, 0, 0}};
  scene.masses = {1, 1};
  scene.gravity = {0, 0, 0};
  scene.fixed = scene.spheres = {0};
  scene.radii = {0.1, 0};
  for (const Settings& settings : all_settings(1e-5)) {
    CAPTURE(text(settings));
    Cloth cloth = cloth_of(scene, settings);
    CHECK(step(cloth, 0.01).status == Status::converged);
    CHECK(cloth.max_penetration() <= settings.contact_tolerance);
    CHECK(cloth.energy().kinetic < 1e-6);  // 0.05 m in 0.01 s would be 12 J
  }
}

TEST_CASE("what a projection leaves undone is for the step to tell") {
  SceneDescription scene = weightless("hang", 6);
  for (Vec3& p : scene.positions) p.x *= 1.3;
  Settings settings = on(each_backend());
  int converged = 0;
  for (settings.max_iterations = 10; settings.max_iterations <= 300;
       settings.max_iterations += 10) {
    Cloth cloth = cloth_of(scene, settings);
    const StepReport report = step(cloth, 0.01);
    CAPTURE(settings.max_iterations);
    CHECK((report.status == Status::converged) == (report.max_strain <= settings.tolerance));
    converged += report.status == Status::converged;
  }
  CHECK(converged > 0);
  CHECK(converged < 30);
}

TEST_CASE("what a step left out of tolerance is no start: the next one makes speed of it") {
  SceneDescription scene = weightless("hang", 6);
  for (Vec3& p : scene.positions) p.x *= 1.1;
  Settings settings = on(each_backend());
  settings.max_iterations = 20;
  Cloth stepped = cloth_of(scene, settings), placed = cloth_of(scene, settings);
  REQUIRE(step(stepped, 0.01).status == Status::iteration_limit);
  REQUIRE(placed.write_positions(positions(stepped)));
  REQUIRE(placed.write_velocities(velocities(stepped)));
  CHECK(step(stepped, 0.01).status == Status::converged);
  CHECK(step(placed, 0.01).status == Status::converged);
  CHECK(stepped.energy().kinetic > 0.01);
  CHECK(placed.energy().kinetic < 1e-6);
}

TEST_CASE("with a fixed number of iterations nothing is projected") {
  SceneDescription scene = free_bar(1, 1);
  scene.positions[1].x = 1.5;
  Settings settings = on(each_backend());
  settings.iterations = 1;
  Cloth cloth = cloth_of(scene, settings);
  CHECK(step(cloth, 0.01).iterations == 1);
  CHECK(cloth.velocity(1).x == doctest::Approx(-25).epsilon(1e-6));
}

TEST_CASE("pins that are placed elsewhere move a cloth without making it fast") {
  for (const Settings& settings : all_settings(1e-5)) {
    for (const double jump : {0.1, 1.0}) {
      CAPTURE(text(settings));
      CAPTURE(jump);
      const SceneDescription scene = weightless("hang", 6);
      Cloth cloth = cloth_of(scene, settings);
      step(cloth, 0.01);
      for (const std::uint32_t pin : scene.fixed) {
        const Vec3 p = scene.positions[pin];
        REQUIRE(cloth.place_fixed(pin, {p.x - jump, p.y, p.z}));
      }
      CHECK(step(cloth, 0.01).status == Status::converged);
      CHECK(cloth.energy().kinetic < 1e-6);
      run(cloth, 0.01, 3);
      CHECK(cloth.energy().kinetic < 1e-6);
    }
  }
}

// What one step leaves undone the next one solves for, and would make speed of.
TEST_CASE("a jump that takes more iterations than a step may do makes no cloth fast either") {
  SceneDescription net = weightless("hang", 12);
  for (Constraint& c : net.constraints) c.kind = ConstraintKind::rope;
  for (const Solver solver : {Solver::gauss_seidel, Solver::yarn, Solver::direct}) {
    for (const int most : {20, 100}) {
      CAPTURE(name(solver));
      CAPTURE(most);
      Cloth cloth = cloth_of(net, {.max_iterations = most, .solver = solver});
      step(cloth, 0.01);
      for (const std::uint32_t pin : net.fixed) {
        const Vec3 p = net.positions[pin];
        REQUIRE(cloth.place_fixed(pin, {p.x - 1, p.y, p.z}));
      }
      for (int k = 0; k < 100; ++k) {
        step(cloth, 0.01);
        CHECK(cloth.energy().kinetic < 1);
      }
    }
  }
}

TEST_CASE("a pin that moves step by step takes the cloth along at its speed") {
  for (Settings settings : all_settings(1e-5)) {
    for (const int substeps : {1, 3}) {
      CAPTURE(text(settings));
      CAPTURE(substeps);
      settings.substeps = substeps;
      SceneDescription scene = free_bar(1, 1);
      scene.fixed = {0};
      Cloth cloth = cloth_of(scene, settings);
      for (int k = 1; k <= 20; ++k) {
        REQUIRE(cloth.move_fixed(0, {-0.01 * k, 0, 0}));
        CHECK(step(cloth, 0.01).status == Status::converged);
        CHECK(distance(cloth.position(0), {-0.01 * k, 0, 0}) == 0);
        CHECK(distance(cloth.position(1), {1 - 0.01 * k, 0, 0}) < 1e-4);
        CHECK(distance(cloth.velocity(1), {-1, 0, 0}) < 1e-3);
        CHECK(length(cloth.velocity(0)) == 0);
      }
    }
  }
}

TEST_CASE("pins that written positions put down travel no more") {
  SceneDescription scene = free_bar(1, 1);
  scene.fixed = {0};
  for (const Settings& settings : all_settings(1e-5)) {
    CAPTURE(text(settings));
    Cloth cloth = cloth_of(scene, settings);
    REQUIRE(cloth.move_fixed(0, {-0.01, 0, 0}));
    step(cloth, 0.01);
    REQUIRE(cloth.write_positions(scene.positions));
    REQUIRE(cloth.write_velocities(std::vector<Vec3>(2)));
    step(cloth, 0.01);
    CHECK(length(cloth.velocity(1)) < 1e-3);
    for (const double speed : {1.9, 3.8}) {
      const Vec3 at = cloth.position(0);
      REQUIRE(cloth.move_fixed(0, {at.x - speed * 0.01, 0, 0}));
      step(cloth, 0.01);
    }
    CHECK(length(cloth.velocity(1)) > 3);
  }
}

TEST_CASE("a cloth that is moved as a whole is towed on at its speed") {
  SceneDescription scene = free_bar(1, 1);
  scene.fixed = {0};
  constexpr double kAway = 100, kSpeed = 8, kStep = 1. / 60;
  for (const Settings& settings : all_settings(1e-5)) {
    CAPTURE(text(settings));
    Cloth cloth = cloth_of(scene, settings);
    double speed = 0, x = 0;
    const auto tow = [&] {
      speed = std::min(kSpeed, speed + 100 * kStep);
      x -= speed * kStep;
      REQUIRE(cloth.move_fixed(0, {x, 0, 0}));
      step(cloth, kStep);
    };
    for (int k = 0; k < 20; ++k) tow();
    REQUIRE(cloth.velocity(1).x == doctest::Approx(-kSpeed).epsilon(1e-3));
    std::vector<Vec3> moved{cloth.position(0), cloth.position(1)};
    for (Vec3& p : moved) p.x += kAway;
    x += kAway;
    REQUIRE(cloth.write_positions(moved));
    for (int k = 0; k < 3; ++k) {
      tow();
      CHECK(cloth.velocity(1).x == doctest::Approx(-kSpeed).epsilon(1e-3));
    }
  }
}

// The pin swings as A sin(w t), slowly beside the pendulum that hangs from it.
TEST_CASE("rattle follows a moving pin to second order") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0, -1, 0}};
  scene.masses = {1, 1};
  scene.fixed = {0};
  scene.constraints = {{0, 1, 1}};
  const auto end = [&](int parts) {
    Settings settings = tight(1e-10);
    settings.scheme = Scheme::rattle;
    settings.solver = Solver::direct;
    Cloth cloth = cloth_of(scene, settings);
    const double dt = 0.02 / parts;
    for (int k = 1; k <= 50 * parts; ++k) {
      REQUIRE(cloth.move_fixed(0, {0.1 * (1 - std::cos(3 * k * dt)), 0, 0}));
      CHECK(step(cloth, dt).scheme_fallbacks == 0);
    }
    return cloth.position(1);
  };
  const Vec3 converged = end(32);
  const double coarse = distance(end(1), converged), fine = distance(end(4), converged);
  CHECK(std::log2(coarse / fine) / 2 > 1.8);
}

TEST_CASE("a pin travels however far it is sent") {
  SceneDescription scene = free_bar(1, 1);
  scene.fixed = {0};
  for (const double dt : {0.001, 0.01, 0.033}) {
    for (const double acceleration : {100., 10'000.}) {
      CAPTURE(dt);
      CAPTURE(acceleration);
      Cloth cloth = cloth_of(scene, tight(1e-6));
      const double speed = acceleration * dt;
      REQUIRE(cloth.move_fixed(0, {-speed * dt, 0, 0}));
      step(cloth, dt);
      CHECK(distance(cloth.velocity(1), {-speed, 0, 0}) < 0.01);
    }
  }
}

TEST_CASE("of moves and places of a pin before a step the last counts") {
  SceneDescription scene = free_bar(1, 1);
  scene.fixed = {0};
  for (const Settings& settings : all_settings(1e-5)) {
    CAPTURE(text(settings));
    Cloth cloth = cloth_of(scene, settings);
    REQUIRE(cloth.move_fixed(0, {-0.5, 0, 0}));
    REQUIRE(cloth.place_fixed(0, {-0.2, 0, 0}));
    CHECK(step(cloth, 0.01).pin_work == 0);
    CHECK(distance(cloth.position(1), {0.8, 0, 0}) < 1e-4);
    CHECK(length(cloth.velocity(1)) < 1e-3);
    REQUIRE(cloth.place_fixed(0, {0, 0, 0}));
    REQUIRE(cloth.move_fixed(0, {-0.01, 0, 0}));
    step(cloth, 0.01);
    CHECK(distance(cloth.position(1), {0.99, 0, 0}) < 1e-4);
    CHECK(distance(cloth.velocity(1), {-1, 0, 0}) < 1e-3);
  }
}

TEST_CASE("a pin is placed before a step that is refused, and the cloth follows in the next one") {
  SceneDescription scene = free_bar(1, 1);
  scene.fixed = {0};
  for (const Settings& settings : all_settings(1e-5)) {
    CAPTURE(text(settings));
    Cloth cloth = cloth_of(scene, settings);
    step(cloth, 0.01);
    REQUIRE(cloth.write_forces(std::vector<Vec3>{{0, 0, 0}, {1e300, 0, 0}}));
    REQUIRE(cloth.place_fixed(0, {-0.3, 0, 0}));
    const std::uint64_t before = cloth.state_hash();
    REQUIRE(step(cloth, 0.01).status == Status::non_finite_input);
    CHECK(cloth.state_hash() == before);
    REQUIRE(cloth.write_forces({}));
    step(cloth, 0.01);
    CHECK(distance(cloth.position(1), {0.7, 0, 0}) < 1e-4);
    CHECK(length(cloth.velocity(1)) < 1e-3);
  }
}

TEST_CASE("a pin whose step was refused travels in the next one") {
  SceneDescription scene = free_bar(1, 1);
  scene.fixed = {0};
  for (const Settings& settings : all_settings(1e-5)) {
    CAPTURE(text(settings));
    Cloth cloth = cloth_of(scene, settings);
    step(cloth, 0.01);
    REQUIRE(cloth.write_forces(std::vector<Vec3>{{0, 0, 0}, {1e300, 0, 0}}));
    REQUIRE(cloth.move_fixed(0, {-0.01, 0, 0}));
    REQUIRE(step(cloth, 0.01).status == Status::non_finite_input);
    REQUIRE(cloth.write_forces({}));
    step(cloth, 0.01);
    CHECK(distance(cloth.velocity(1), {-1, 0, 0}) < 1e-3);
  }
}

TEST_CASE("a step that is refused leaves moved pins and written positions as they were") {
  SceneDescription scene = free_bar(1, 1);
  scene.fixed = {0};
  Cloth cloth = cloth_of(scene, on(each_backend()));
  step(cloth, 0.01);
  std::vector<Vec3> stretched = {{0, 0, 0}, {1.5, 0, 0}};
  REQUIRE(cloth.write_positions(stretched));
  REQUIRE(cloth.move_fixed(0, {-0.001, 0, 0}));
  REQUIRE(cloth.write_forces(std::vector<Vec3>{{0, 0, 0}, {1e300, 1e300, 0}}));
  const std::uint64_t before = cloth.state_hash();
  CHECK(step(cloth, 0.01).status == Status::non_finite_input);
  CHECK(cloth.state_hash() == before);
  REQUIRE(cloth.write_forces({}));
  step(cloth, 0.01);
  CHECK(distance(cloth.position(1), {0.999, 0, 0}) < 0.011);
  CHECK(length(cloth.velocity(1)) < 2);
}

TEST_CASE("a cloth that is put back where it began goes on like a new one, in a short step too") {
  SceneDescription scene = scene_of("hang", 12);
  for (Vec3& p : scene.positions) p.x *= 1.004;  // within tolerance
  const std::vector<Vec3> at_rest(scene.positions.size());
  for (const Solver solver : {Solver::yarn, Solver::direct, Solver::automatic}) {
    CAPTURE(name(solver));
    Cloth used = cloth_of(scene, {.solver = solver}), fresh = cloth_of(scene, {.solver = solver});
    run(used, 1. / 60, 3);
    REQUIRE(used.write_positions(scene.positions));
    REQUIRE(used.write_velocities(at_rest));
    step(used, 1. / 1200);
    step(fresh, 1. / 1200);
    CHECK(used.state_hash() == fresh.state_hash());
  }
}

}  // namespace
}  // namespace weft::test::engine_step_starts
