/// Constraints that cannot all be met: said so, settled, and left behind without a jump.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_infeasible {
namespace {

constexpr double kLink = 0.01;
constexpr int kLinks = 19;

/// A level chain, its ends fixed `stretch` times its length apart.
SceneDescription pulled_chain(double stretch, std::uint32_t links = kLinks) {
  SceneDescription scene;
  for (std::uint32_t i = 0; i <= links; ++i) {
    scene.positions.push_back({stretch * kLink * i, 0, 0});
    scene.masses.push_back(1);
    if (i > 0) scene.constraints.push_back({i - 1, i, kLink});
  }
  scene.fixed = {0, links};
  return scene;
}

/// A skirt: yarns down and around, the upper ring fixed, and one particle of the hem.
SceneDescription skirt() {
  constexpr std::uint32_t kAround = 24, kDown = 12;
  SceneDescription scene;
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    scene.constraints.push_back({a, b, distance(scene.positions[a], scene.positions[b])});
  };
  for (std::uint32_t i = 0; i < kDown; ++i) {
    for (std::uint32_t j = 0; j < kAround; ++j) {
      const double down = i / (kDown - 1.), angle = 2 * std::numbers::pi * j / kAround;
      const double radius = 0.15 + 0.25 * down;
      scene.positions.push_back({radius * std::cos(angle), -0.6 * down, radius * std::sin(angle)});
      scene.masses.push_back(0.001);
      if (i == 0) scene.fixed.push_back(j);
    }
    for (std::uint32_t j = 0; j < kAround; ++j) {
      const std::uint32_t here = i * kAround + j;
      join(here, i * kAround + (j + 1) % kAround);
      if (i > 0) join(here - kAround, here);
    }
  }
  scene.fixed.push_back((kDown - 1) * kAround);
  return scene;
}

/// What stands after it in a test case runs with each.
Solver each_solver() {
  Solver solver = Solver::gauss_seidel;
  SUBCASE("by relaxation") { solver = Solver::gauss_seidel; }
  SUBCASE("directly") { solver = Solver::direct; }
  return solver;
}

Settings by(Solver solver, Backend backend) {
  Settings settings = on(backend);
  settings.solver = solver;
  return settings;
}

TEST_CASE("a chain with its ends too far apart says so, and comes to rest") {
  const Backend backend = each_backend();
  const Solver solver = each_solver();
  Cloth cloth = cloth_of(pulled_chain(1.1), by(solver, backend));
  for (int k = 0; k < 50; ++k) {
    const StepReport report = step(cloth, 0.01);
    CHECK(report.status == Status::infeasible);
    CHECK(report.iterations < 300'000);
    CHECK(report.max_strain > 0.1);  // some edge has its share or more
    CHECK(report.max_strain < 0.25);
    CHECK(report.worst_constraint < kLinks);
  }
  const std::vector<Vec3> before = positions(cloth);
  step(cloth, 0.01);
  CHECK(largest_distance(positions(cloth), before) < 1e-6);
}

/// Its errors do not settle: they rise and fall for ever.
TEST_CASE("a skirt whose hem is pulled too far is soon known to be") {
  const SceneDescription scene = skirt();
  for (const Solver solver : {Solver::gauss_seidel, Solver::yarn}) {
    CAPTURE(name(solver));
    Cloth cloth = cloth_of(scene, {.substeps = 1, .solver = solver});
    const std::uint32_t hem = scene.fixed.back();
    Vec3 at = cloth.position(hem);
    for (int k = 0; k < 8; ++k) {
      at.y -= 0.02;
      REQUIRE(cloth.move_fixed(hem, at));
      const StepReport report = step(cloth, 1. / 60);
      CAPTURE(k);
      CHECK(report.iterations < 250'000);
      if (k >= 2) CHECK(report.status == Status::infeasible);
    }
    REQUIRE(cloth.write_positions(scene.positions));
    CHECK(step(cloth, 1. / 60).status == Status::converged);
  }
}

TEST_CASE("ends that come back free the chain again") {
  const Backend backend = each_backend();
  const Solver solver = each_solver();
  Cloth cloth = cloth_of(pulled_chain(1.1), by(solver, backend));
  run(cloth, 0.01, 20);
  double most_kinetic = 0;
  for (int k = 1; k <= 100; ++k) {
    const double stretch = 1.1 - 0.2 * k / 100;
    REQUIRE(cloth.move_fixed(kLinks, {stretch * kLinks * kLink, 0, 0}));
    const StepReport report = step(cloth, 0.01);
    most_kinetic = std::max(most_kinetic, cloth.energy().kinetic);
    if (stretch < 0.98) CHECK(report.status == Status::converged);
  }
  // 18 kg that fall by 5 cm, as the chain does when its ends are a tenth nearer, have 9 J.
  CHECK(most_kinetic < 3);
}

TEST_CASE("a loop that is slow is not taken for one that gets nowhere because the last one was") {
  constexpr std::uint32_t kMany = 600;
  Cloth cloth = cloth_of(pulled_chain(1.0105, kMany), paper_settings());
  REQUIRE(step(cloth, 0.01).status == Status::infeasible);
  REQUIRE(cloth.place_fixed(kMany, {kMany * kLink, 0, 0}));
  const StepReport report = step(cloth, 0.01);
  CHECK(report.iterations > 8192);  // two looks
  CHECK(report.status == Status::converged);
}

TEST_CASE("a loop that is merely slow is not taken for one that gets nowhere") {
  const Backend backend = each_backend();
  SceneDescription scene = scene_of("chain", 20);
  scene.masses.back() = 1000;
  Settings settings = on(backend);
  settings.tolerance = 0.001;
  Cloth cloth = cloth_of(scene, settings);
  for (int k = 0; k < 10; ++k) CHECK(step(cloth, 1. / 60).status == Status::converged);
}

/// `work`, the largest of a frame in units of its substeps' sweeps; local passes take eight times
/// as long for a visit.
double most_work(Cloth& cloth, int frames, const auto& before_frame) {
  const auto constraints = static_cast<double>(describe(*cloth.model()).constraints);
  double most = 0;
  for (int frame = 0; frame < frames; ++frame) {
    before_frame(frame);
    const StepReport report = step(cloth, 1. / 60);
    const auto sweeps = static_cast<double>(report.direction_updates);
    const double local = static_cast<double>(report.visits) / constraints - sweeps;
    most = std::max(most, (sweeps + 8 * local) / report.substeps);
    CHECK(report.status == Status::infeasible);
  }
  return most;
}

TEST_CASE("small steps take little longer where two pins are too far apart") {
  const Backend backend = each_backend();
  SceneDescription scene = scene_of("banner", 15);
  Cloth cloth = cloth_of(scene, {.solver = Solver::small_steps, .backend = backend});
  const std::uint32_t pin = scene.fixed.back();
  const Vec3 away = 0.03 * (cloth.position(pin) - cloth.position(scene.fixed.front()));
  const auto move = [&](double by) {
    REQUIRE(cloth.move_fixed(pin, cloth.position(pin) + by * away));
  };
  run(cloth, 1. / 60, 10);
  CHECK(most_work(cloth, 12, [&](int) { move(1); }) < 8);
  for (int k = 0; k < 14; ++k) {
    move(-1);
    step(cloth, 1. / 60);
  }
  run(cloth, 1. / 60, 20);
  CHECK(step(cloth, 1. / 60).status == Status::converged);
}

}  // namespace
}  // namespace weft::test::engine_step_infeasible
