/// The decay of motion: exact for any step.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test {
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

TEST_CASE("a sheet that swings loses energy, the faster the larger the rate") {
  for (const Solver solver : kSolvers) {
    CAPTURE(name(solver));
    double before = 0;
    for (const double rate : {0., 0.5, 5.}) {
      CAPTURE(rate);
      SceneDescription scene = scene_of("corners", 11);
      scene.damping.motion = rate;
      Cloth cloth = cloth_of(scene, {.solver = solver});
      const double start = cloth.energy().total();
      double least = start;
      for (int k = 0; k < 100; ++k) {
        step(cloth, 0.01);
        CHECK(cloth.energy().total() < least + 1e-3);
        least = std::min(least, cloth.energy().total());
      }
      const double lost = start - cloth.energy().total();
      CHECK(lost > before + (rate > 0 ? 0.02 : -1));
      before = lost;
    }
  }
}

/// Two free bars that are one too many for the ends they join: no attempt succeeds, and the last
/// is committed. Attempts that are taken back must leave the velocities to the next.
TEST_CASE("attempts that are rejected have damped nothing") {
  for (const Solver solver : {Solver::yarn, Solver::direct}) {
    CAPTURE(name(solver));
    SceneDescription scene = flying_sheet(10, {1, 2, 3}, {});
    scene.constraints.push_back({0, 24, 0.5});  // nearer than its rows can be folded in a step
    scene.velocities[12] = {60, 60, -60};
    Cloth cloth = cloth_of(scene, {.max_iterations = 400, .solver = solver});
    const Vec3 before = momentum(scene.masses, scene.velocities);
    const StepReport report = step(cloth, 0.01);
    REQUIRE(committed(report.status));
    REQUIRE(report.halvings > 0);
    // Bars keep the momentum; the guard may take from it, and the decay must do so once.
    const Vec3 after = momentum(scene.masses, velocities(cloth));
    CHECK(length(after) <= std::exp(-0.1) * length(before) * (1 + 1e-5));
    CHECK(length(after) > 0.2 * length(before));
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
        REQUIRE(cloth.move_fixed(pin, {at.x, at.y, at.z + 0.01}));
      }
      REQUIRE(step(cloth, 0.01).status == Status::converged);
    }
    for (const std::uint32_t pin : scene.fixed) {
      CHECK(cloth.position(pin).z == doctest::Approx(scene.positions[pin].z + 0.1));
    }
    CHECK(cloth.velocity(2 * 5).z > 0.5);  // the cloth follows at 1 m/s
  }
}

}  // namespace
}  // namespace weft::test
