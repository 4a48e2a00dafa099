/// The decay of motion: exact for any step.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_decay {
namespace {

constexpr Solver kSolvers[] = {Solver::small_steps, Solver::gauss_seidel, Solver::yarn,
                               Solver::direct};

/// A sheet that moves as one, with the given rate of decay.
SceneDescription flying_sheet(double rate, Vec3 velocity, Vec3 gravity) {
  SceneDescription scene = scene_of("hang", 5);
  scene.fixed.clear();
  scene.velocities.assign(scene.positions.size(), velocity);
  scene.gravity = gravity;
  scene.damping.motion = rate;
  return scene;
}

TEST_CASE("without forces velocities fall by exp(-c t), whatever the step") {
  const Vec3 start{3, -2, 1};
  for (const Solver solver : kSolvers) {
    for (const double rate : {0.1, 1., 10.}) {
      for (const double dt : {0.001, 0.1}) {
        CAPTURE(name(solver));
        CAPTURE(rate);
        CAPTURE(dt);
        Cloth cloth = cloth_of(flying_sheet(rate, start, {}), {.solver = solver});
        run(cloth, dt, 7);
        const Vec3 expected = std::exp(-rate * 7 * dt) * start;
        for (const Vec3& v : velocities(cloth)) {
          CHECK(distance(v, expected) < 2e-5 * length(expected) + 1e-6);
        }
      }
    }
  }
}

TEST_CASE("what falls reaches g / c, whatever the step") {
  for (const Solver solver : kSolvers) {
    for (const double rate : {1., 10.}) {
      for (const double dt : {0.01, 0.1}) {
        CAPTURE(name(solver));
        CAPTURE(rate);
        CAPTURE(dt);
        Cloth cloth = cloth_of(flying_sheet(rate, {}, {0, -10, 0}), {.solver = solver});
        run(cloth, dt, static_cast<int>(1 / (rate * dt)));
        const double t = std::floor(1 / (rate * dt)) * dt;
        const double then = 10 / rate * (1 - std::exp(-rate * t));
        for (const Vec3& v : velocities(cloth)) {
          CHECK(distance(v, {0, -then, 0}) < 1e-4 * then);
        }
        run(cloth, dt, static_cast<int>(12 / (rate * dt)));
        for (const Vec3& v : velocities(cloth)) {
          CHECK(distance(v, {0, -10 / rate, 0}) < 1e-4 * 10 / rate);
        }
      }
    }
  }
}

TEST_CASE("a pinned sheet whose motion decays at once creeps, whatever the step") {
  for (const Settings& settings :
       {Settings{.solver = Solver::small_steps},
        Settings{.solver = Solver::small_steps, .scheme = Scheme::implicit}}) {
    for (const double rate : {1e4, 1e6, 1e12}) {
      for (const double dt : {1. / 240, 1. / 60, 0.1}) {
        CAPTURE(rate);
        CAPTURE(dt);
        SceneDescription scene = scene_of("hang", 5);
        scene.damping.motion = rate;
        Cloth cloth = cloth_of(scene, settings);
        for (int k = 0; k < 5; ++k) REQUIRE(step(cloth, dt).status == Status::converged);
        for (const Vec3& v : velocities(cloth)) CHECK(length(v) < 10.1 / rate + 1e-6);
      }
    }
  }
}

TEST_CASE("what hangs on a spring comes to rest under its whole weight") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0, -1, 0}};
  scene.masses = {1, 0.2};
  scene.fixed = {0};
  scene.constraints = {{0, 1, 1, ConstraintKind::distance, 0.01}};  // 2 cm under 2 N
  for (const Backend backend : kBackends) {
    for (const Scheme scheme : {Scheme::implicit, Scheme::bdf2}) {
      for (const double rate : {1., 20., 200.}) {
        CAPTURE(name(scheme));
        CAPTURE(rate);
        scene.damping.motion = rate;
        Cloth cloth = cloth_of(scene, {.tolerance = 1e-6, .scheme = scheme, .backend = backend});
        run(cloth, 1. / 60, rate == 1 ? 1200 : 120);
        CHECK(-1 - cloth.position(1).y == doctest::Approx(0.02).epsilon(1e-3));
      }
    }
  }
}

TEST_CASE("a sheet that swings loses energy, the faster the larger the rate") {
  for (const Solver solver : kSolvers) {
    CAPTURE(name(solver));
    double before = -1;
    for (const double rate : {0., 0.5, 5.}) {
      CAPTURE(rate);
      SceneDescription scene = scene_of("hang", 11);
      scene.damping.motion = rate;
      Cloth cloth = cloth_of(scene, {.solver = solver});
      const double start = cloth.energy().total();
      for (int k = 0; k < 50; ++k) {
        step(cloth, 0.01);
        CHECK(cloth.energy().total() < start + 1e-6);
      }
      const double lost = start - cloth.energy().total();
      CHECK(lost > before + 0.1);
      before = lost;
    }
  }
}

/// A sheet so fast in itself that its first attempts are taken back. Rigid edges keep momentum, of
/// which the decay takes its share once.
TEST_CASE("attempts that are rejected have damped nothing") {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    SceneDescription scene = flying_sheet(10, {}, {});
    for (Vec3& v : scene.velocities) v = Vec3{10, 0, 0} + random.in_box(150);
    Cloth cloth = cloth_of(
        scene,
        {.substeps = 1, .max_iterations = 400, .solver = Solver::direct, .scheme = Scheme::paper});
    const StepReport report = step(cloth, 0.02);
    REQUIRE(report.halvings > 0);
    const Vec3 expected = std::exp(-0.2) * momentum(scene.masses, scene.velocities);
    const Vec3 after = momentum(scene.masses, velocities(cloth));
    CHECK(distance(after, expected) < 1e-5 * length(expected));
  }
}

TEST_CASE("a step that fails has damped nothing") {
  for (const Solver solver : kSolvers) {
    CAPTURE(name(solver));
    SceneDescription scene = scene_of("hang", 5);
    scene.damping.motion = 3;
    Cloth cloth = cloth_of(scene, {.max_iterations = 1000, .solver = solver});
    run(cloth, 0.01, 5);
    Cloth other = cloth.clone();
    std::vector<Vec3> huge(scene.positions.size());
    huge[20] = {1e308, 0, 0};
    REQUIRE(cloth.write_forces(huge));
    const std::uint64_t before = cloth.state_hash();
    CHECK_FALSE(committed(step(cloth, 0.01).status));
    CHECK(cloth.state_hash() == before);
    REQUIRE(cloth.write_forces({}));
    run(cloth, 0.01, 3);
    run(other, 0.01, 3);
    CHECK(cloth.state_hash() == other.state_hash());
  }
}

TEST_CASE("pins that are moved are not slowed down") {
  SceneDescription scene = scene_of("hang", 5);
  scene.damping.motion = 5;
  for (const Solver solver : kSolvers) {
    CAPTURE(name(solver));
    Cloth cloth = cloth_of(scene, {.solver = solver});
    for (int k = 0; k < 10; ++k) {
      for (const std::uint32_t pin : scene.fixed) {
        const Vec3 at = cloth.position(pin);
        REQUIRE(cloth.move_fixed(pin, {at.x - 0.01, at.y, at.z}));
      }
      REQUIRE(step(cloth, 0.01).status == Status::converged);
    }
    for (const std::uint32_t pin : scene.fixed) {
      CHECK(cloth.position(pin).x == doctest::Approx(scene.positions[pin].x - 0.1));
    }
    CHECK(cloth.velocity(1 * 5 + 2).x < -0.7);  // the next row follows at 1 m/s
  }
}

}  // namespace
}  // namespace weft::test::engine_step_decay
