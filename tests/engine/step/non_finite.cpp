/// Steps that overflow: the state stays as it was, and the report says so.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "tests/support/bending.h"
#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_non_finite {
namespace {

/// Spoils a particle of a hanging sheet, steps it, and expects the refusal; then heals it and
/// expects a step.
void check_overflow(std::uint32_t spoilt, const std::function<void(Cloth&)>& spoil) {
  for (const Method& method : kAllMethods) {
    for (const bool velocity_correction : {false, true}) {
      CAPTURE(text(method));
      CAPTURE(velocity_correction);
      Settings settings = with(paper_settings(), method);
      settings.velocity_correction = velocity_correction;
      settings.max_iterations = 1000;
      const SceneDescription scene = scene_of("hang_sphere", 4);
      Cloth cloth = cloth_of(scene, settings);
      run(cloth, 0.01, 3);
      const std::vector<Vec3> healthy = velocities(cloth);
      spoil(cloth);
      const std::uint64_t before = cloth.state_hash();
      const StepReport report = step(cloth, 0.01);
      CHECK(report.status == Status::non_finite_input);
      CHECK(report.failed_particle == spoilt);
      CHECK(cloth.state_hash() == before);
      CHECK(std::isfinite(report.max_strain));

      REQUIRE(cloth.write_velocities(healthy));
      REQUIRE(cloth.write_forces({}));
      CHECK(step(cloth, 0.01).status == Status::converged);
      CHECK(cloth.state_hash() != before);
      CHECK(std::isfinite(cloth.strain().max));
    }
  }
}

TEST_CASE("a length that overflows changes nothing, even between positions that do not") {
  for (const double huge : {1e160, 1e308}) {
    CAPTURE(huge);
    check_overflow(6, [huge](Cloth& cloth) {
      std::vector<Vec3> v = velocities(cloth);
      v[6] = {huge, -huge, huge};
      REQUIRE(cloth.write_velocities(v));
    });
  }
}

TEST_CASE("an overflow ends the step early: no iteration can mend it") {
  for (const Method& method : kAllMethods) {
    for (const bool velocity_correction : {false, true}) {
      CAPTURE(text(method));
      CAPTURE(velocity_correction);
      Settings settings = with(paper_settings(), method);
      settings.max_iterations = 1000;
      settings.velocity_correction = velocity_correction;
      SceneDescription scene = free_bar(1, 1);
      scene.velocities[1] = {1e308, -1e308, 0};
      Cloth cloth = cloth_of(scene, settings);
      const StepReport report = step(cloth, 100);
      CHECK(report.status == Status::non_finite_input);
      CHECK(report.iterations < 100);
      CHECK(report.velocity_iterations < 100);
    }
  }
}

TEST_CASE("a force that overflows changes nothing") {
  check_overflow(5, [](Cloth& cloth) {
    std::vector<Vec3> forces(cloth.particle_count());
    forces[5] = {1e308, 0, 0};
    REQUIRE(cloth.write_forces(forces));
  });
}

/// A force that takes the last particle out of the range of numbers.
void spoil_last(Cloth& cloth, double force = 1e308) {
  std::vector<Vec3> forces(cloth.particle_count());
  forces.back() = {force, 0, 0};
  REQUIRE(cloth.write_forces(forces));
}

/// A step that fails leaves every byte of what is saved. Returns whether it failed.
bool fails_without_a_trace(Cloth& cloth, double dt = 0.01) {
  const std::vector<std::byte> before = cloth.save_state();
  if (committed(step(cloth, dt).status)) return false;
  CHECK(cloth.save_state() == before);
  return true;
}

TEST_CASE("a step that fails leaves pins that are under way as they were") {
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    const SceneDescription scene = scene_of("hang", 4);
    Cloth cloth = cloth_of(scene, with(paper_settings(), method));
    const auto send = [&](double x) { REQUIRE(cloth.move_fixed(0, {x, 0.01, 0})); };
    send(0.01);
    run(cloth, 0.01, 2);
    REQUIRE(cloth.carry({.rotation = {0, 1, 0}}, 1));  // zeros become negative
    send(0.02);
    spoil_last(cloth);
    CHECK(fails_without_a_trace(cloth));
  }
}

TEST_CASE("a step that fails leaves anchors that take hold again as they were") {
  const Backend backend = each_backend();
  constexpr double kFree = std::numeric_limits<double>::infinity();
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}};
  scene.masses = {1, 1};
  scene.anchors = {{.particle = 0, .point = {0, 0, 0}, .max_distance = 0.5}};
  Cloth cloth = cloth_of(scene, {.solver = Solver::small_steps, .backend = backend});
  REQUIRE(cloth.limit_anchor(0, {.max_distance = kFree}));
  run(cloth, 0.01, 10);
  REQUIRE(cloth.limit_anchor(0, {.max_distance = 0.01}));
  spoil_last(cloth);
  CHECK(fails_without_a_trace(cloth));
}

TEST_CASE("a step that fails leaves seams as they were, though positions were given") {
  const Backend backend = each_backend();
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {5, 0, 0}};
  scene.masses = {1, 1, 1};
  scene.seams = {{.a = 0, .b = 1, .time = 0.5}};
  Cloth cloth = cloth_of(scene, {.solver = Solver::small_steps, .backend = backend});
  run(cloth, 0.01, 10);
  REQUIRE(cloth.write_positions(positions(cloth)));
  spoil_last(cloth);
  CHECK(fails_without_a_trace(cloth));
}

/// Four times as much force each time, so that the first, the last or no substep fails.
void check_some_forces(const SceneDescription& scene, const Settings& settings, bool placed) {
  int failed = 0, done = 0;
  for (double force = 1e28; force < 1e160; force *= 4) {
    Cloth cloth = cloth_of(scene, settings);
    run(cloth, 0.01, 1);
    if (placed) REQUIRE(cloth.write_positions(positions(cloth)));
    spoil_last(cloth, force);
    ++(fails_without_a_trace(cloth) ? failed : done);
  }
  CHECK(failed > 0);
  CHECK(done > 0);
}

TEST_CASE("a step of which a later substep fails changes nothing") {
  SceneDescription scene = scene_of("hang", 4);
  scene.positions.push_back({5, 0, 0});
  scene.masses.push_back(1);
  for (const double compliance : {0., 1e-4}) {
    for (Constraint& c : scene.constraints) c.compliance = compliance;
    for (const Solver solver :
         {Solver::small_steps, Solver::gauss_seidel, Solver::yarn, Solver::direct}) {
      for (const bool placed : {false, true}) {
        CAPTURE(compliance);
        CAPTURE(name(solver));
        CAPTURE(placed);
        check_some_forces(scene, {.substeps = 5, .solver = solver}, placed);
      }
    }
  }
}

TEST_CASE("an unconstrained particle that overflows changes nothing") {
  const Backend backend = each_backend();
  SceneDescription scene;
  scene.positions = {{1e308, 0, 0}};
  scene.velocities = {{1e308, 0, 0}};
  scene.masses = {1};
  Cloth cloth = cloth_of(scene, on(backend));
  const std::uint64_t before = cloth.state_hash();
  CHECK(step(cloth, 10).status == Status::non_finite_input);
  CHECK(cloth.state_hash() == before);
}

TEST_CASE("a velocity out of range changes nothing, though the position it leads to is in it") {
  const Backend backend = each_backend();
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0, 0, 0}};
  scene.velocities = {{0, 0, 0}, {0, 2e150, 0}};
  scene.masses = {1, 1};
  Cloth cloth = cloth_of(scene, on(backend));
  const std::uint64_t before = cloth.state_hash();
  const StepReport report = step(cloth, 0.01);
  CHECK(report.status == Status::non_finite);
  CHECK(report.failed_particle == 1);
  CHECK(cloth.state_hash() == before);
}

// Two bars in nearly the same direction: only far across them their common end is as fast along
// each as the other ends are.
TEST_CASE("a velocity that its correction takes out of range changes nothing") {
  constexpr double kSpeed = 5e149, kAcross = 0.05;
  SceneDescription scene;
  scene.gravity = {0, 0, 0};
  scene.positions = {{0, 0, 0}, {-1, kAcross, 0}, {-1, -kAcross, 0}};
  scene.velocities = {{0, 0, 0}, {kSpeed, 0, 0}, {-kSpeed, 0, 0}};
  scene.masses = {1e-3, 1, 1};
  const double rest = std::hypot(1, kAcross);
  scene.constraints = {{0, 1, rest}, {0, 2, rest}};
  Settings settings = on(Backend::reference);
  settings.tolerance = 0.1;
  settings.max_iterations = 10'000;
  settings.velocity_correction = true;
  Cloth cloth = cloth_of(scene, settings);
  const std::uint64_t before = cloth.state_hash();
  const StepReport report = step(cloth, 1e-152);
  CHECK(report.status == Status::non_finite);
  CHECK(report.corrections > 0);
  CHECK(report.failed_particle == 0);
  CHECK(cloth.state_hash() == before);
}

TEST_CASE("the particle that failed is one that can move") {
  const SceneDescription scene = scene_of("hang", 20);
  const auto check = [&](const Settings& settings, double dt) {
    CAPTURE(dt);
    Cloth cloth = cloth_of(scene, settings);
    const StepReport report = step(cloth, dt);
    REQUIRE(report.failed_particle != kNoIndex);
    CHECK(std::ranges::count(scene.fixed, report.failed_particle) == 0);
  };
  for (const Backend backend : kBackends) check(on(backend), 1e308);
  check({}, 1e20);
}

TEST_CASE("an overflow in a fixed number of iterations is seen too") {
  const Backend backend = each_backend();
  SceneDescription scene = free_bar(1, 1);
  scene.velocities[1] = {1e300, 0, 0};
  Settings settings = on(backend);
  settings.iterations = 3;
  Cloth cloth = cloth_of(scene, settings);
  const std::uint64_t before = cloth.state_hash();
  CHECK(step(cloth, 0.01).status == Status::non_finite_input);
  CHECK(cloth.state_hash() == before);
}

TEST_CASE("a step of more seconds than numbers hold changes nothing, of what bends, too") {
  for (const Backend backend : {Backend::reference, Backend::simd}) {
    for (const double dt : {1e100, 1e160, 1e300}) {
      CAPTURE(dt);
      Cloth cloth = cloth_of(cantilever({}), {.solver = Solver::small_steps, .backend = backend});
      const std::uint64_t before = cloth.state_hash();
      CHECK_FALSE(committed(step(cloth, dt).status));
      CHECK(cloth.state_hash() == before);
      CHECK(step(cloth, 0.01).status == Status::converged);
    }
  }
}

TEST_CASE("particles that coincide are parted") {
  for (const Method& method : kAllMethods) {
    for (const double apart : {0.0, 1e-320, 1e-170, 1e-161, 1e-30}) {
      CAPTURE(text(method));
      CAPTURE(apart);
      SceneDescription scene = free_bar(1, 1);
      scene.positions[1].x = apart;
      Cloth cloth = cloth_of(scene, with(tight(1e-9), method));
      const StepReport report = step(cloth, 0.01);
      CHECK(report.status == Status::converged);
      CHECK(max_strain(scene, positions(cloth)) <= 1e-9 * (1 + 1e-6));
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_step_non_finite
