/// Ropes: they pull when taut, and do nothing else.
#include <doctest/doctest.h>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_ropes {
namespace {

TEST_CASE("a slack rope lets its ends fly free") {
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    SceneDescription scene = free_rope(0.2);
    scene.velocities = {{0, 0, 0}, {0.5, 0.5, 0}};
    Settings settings = with(tight(1e-12), method);
    settings.velocity_correction = true;
    Cloth cloth = cloth_of(scene, settings);
    for (int k = 0; k < 100; ++k) CHECK(step(cloth, 0.01).corrections == 0);
    CHECK(distance(cloth.position(1), {0.7, 0.5, 0}) < 1e-14);
    CHECK(distance(cloth.position(0), {0, 0, 0}) == 0);
  }
}

TEST_CASE("a slack rope lets its ends fly free, whatever solves it") {
  SceneDescription scene = free_rope(0.2);
  scene.velocities = {{0, 0, 0}, {0.5, 0.5, 0}};
  for (const Solver solver : {Solver::gauss_seidel, Solver::yarn, Solver::direct}) {
    for (const Scheme scheme : {Scheme::paper, Scheme::rattle}) {
      CAPTURE(name(solver));
      CAPTURE(name(scheme));
      const Settings settings{.solver = solver, .scheme = scheme, .velocity_correction = true};
      Cloth cloth = cloth_of(scene, settings);
      run(cloth, 0.01, 100);
      CHECK(distance(cloth.position(1), {0.7, 0.5, 0}) < 1e-6);
      CHECK(distance(cloth.position(0), {0, 0, 0}) < 1e-6);
    }
  }
}

TEST_CASE("what a rope pulled positions by it owes no velocities") {
  const Backend backend = each_backend();
  SceneDescription scene = free_rope(1.009);
  scene.velocities = {{0, 0, 0}, {0.2, 0, 0}};
  Settings settings = on(backend);
  settings.velocity_tolerance = 0.1;
  settings.velocity_correction = true;
  Cloth cloth = cloth_of(scene, settings);
  const StepReport report = step(cloth, 0.01);
  CHECK(report.corrections == 1);
  const double approach = cloth.velocity(0).x - cloth.velocity(1).x;
  CHECK(approach == doctest::Approx(0.9).epsilon(1e-4));
}

TEST_CASE("a rope runs taut and shares the momentum") {
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    SceneDescription scene = free_rope(0.95);
    scene.velocities = {{0, 0, 0}, {10, 0, 0}};
    Settings settings = with(tight(1e-12), method);
    settings.velocity_correction = true;
    Cloth cloth = cloth_of(scene, settings);
    step(cloth, 0.01);
    CHECK(distance(cloth.position(0), cloth.position(1)) == doctest::Approx(1).epsilon(1e-12));
    CHECK(distance(cloth.velocity(0), {5, 0, 0}) < exactness(method.backend, 1e-9, 10));
    CHECK(distance(cloth.velocity(1), {5, 0, 0}) < exactness(method.backend, 1e-9, 10));
  }
}

TEST_CASE("a taut rope does not push its ends apart") {
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    SceneDescription scene = free_rope(1);
    scene.velocities = {{2, 0, 0}, {-3, 0, 0}};
    Settings settings = with(tight(1e-12), method);
    settings.velocity_correction = true;
    Cloth cloth = cloth_of(scene, settings);
    CHECK(step(cloth, 0.01).corrections == 0);
    CHECK(distance(cloth.velocity(0), {2, 0, 0}) == 0);
    CHECK(distance(cloth.velocity(1), {-3, 0, 0}) == 0);
  }
}

TEST_CASE("a rope that pulled in one step owes no push in the next") {
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    SceneDescription scene = free_rope(0.95);
    scene.velocities = {{0, 0, 0}, {10, 0, 0}};
    Cloth cloth = cloth_of(scene, with(tight(1e-12), method));
    CHECK(step(cloth, 0.01).corrections > 0);
    const std::vector<Vec3> inwards{{1, 0, 0}, {-1, 0, 0}};
    REQUIRE(cloth.write_velocities(inwards));
    CHECK(step(cloth, 0.01).corrections == 0);
    CHECK(largest_distance(velocities(cloth), inwards) == 0);
  }
}

TEST_CASE("a rope's early pull is taken back") {
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    Cloth cloth = cloth_of(early_pull(), with(tight(1e-12), method));
    const StepReport report = step(cloth, 0.01);
    CHECK(report.status == Status::converged);
    CHECK(distance(cloth.position(2), {0.6, 0, 0}) < exactness(method.backend, 1e-10, 0.6));
    CHECK(distance(cloth.position(3), {1.6, 0, 0}) < exactness(method.backend, 1e-10, 0.6));
    CHECK(distance(cloth.position(4), {-0.35, 0, 0}) < exactness(method.backend, 1e-10, 0.6));
    CHECK(length(cloth.velocity(4)) < exactness(method.backend, 1e-8, 60));
  }
}

TEST_CASE("a rope's strain is its excess alone") {
  const Backend backend = each_backend();
  SceneDescription scene = free_rope(0.5);
  CHECK(cloth_of(scene, on(backend)).strain().max == 0);
  scene.positions[1].x = 1.25;
  CHECK(cloth_of(scene, on(backend)).strain().max == doctest::Approx(0.25).epsilon(1e-15));
}

}  // namespace
}  // namespace weft::test::engine_step_ropes
