/// Tethers against closed forms, on both backends.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "engine/c_interface/scene_arrays.h"
#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_small_steps_tethers {
namespace {

constexpr double kRates[] = {30, 60, 240};  // Hz
constexpr double kUntethered = std::numeric_limits<double>::infinity();

/// A particle at `start`, which a tether of 1 m holds at a pin in the origin.
SceneDescription pendulum(Vec3 start, double mass = 1) {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, start};
  scene.masses = {1, mass};
  scene.fixed = {0};
  scene.tethers = {{.particle = 1, .pin = 0, .length = 1}};
  return scene;
}

/// A hanging sheet that is let go level, of a fabric with this stiffness, N/m.
SceneDescription sheet(std::uint32_t size, const char* material, double stiffness, double slack) {
  scenes::Options options;
  options.size = static_cast<int>(size);
  options.material = find_material(material).value();
  options.material->warp = options.material->weft = stiffness;
  auto scene = scenes::make("hang", options);
  REQUIRE_MESSAGE(scene, scene.error());
  scene.value().tether_slack = slack;
  return scene.value();
}

/// m, by which a particle (i, j) of the sheet is farther from (0, j) than i edges are long.
double largest_excess(const Cloth& cloth, std::uint32_t size) {
  double most = 0;
  for (std::uint32_t k = 0; k < size * size; ++k) {
    const double edges = k / size, l = distance(cloth.position(k), cloth.position(k % size));
    most = std::max(most, l - edges / (size - 1));
  }
  return most;
}

TEST_CASE("what hangs on a tether swings as a pendulum, at any frame rate") {
  const double angle = 1.2, end = pendulum_period(angle) / 2;
  const Vec3 start{std::sin(angle), -std::cos(angle), 0};
  for (const Backend backend : kBackends) {
    for (const double rate : kRates) {
      const int frames = static_cast<int>(std::round(end * rate));
      Cloth cloth = cloth_of(pendulum(start), {.substeps = static_cast<int>(480 / rate),
                                               .solver = Solver::small_steps,
                                               .backend = backend});
      for (int frame = 0; frame < frames; ++frame) {
        const StepReport report = step(cloth, end / frames);
        CHECK(report.status == Status::converged);
        CHECK(report.max_anchor_error < 1e-6);
      }
      CAPTURE(rate);
      CHECK(distance(cloth.position(1), {-start.x, start.y, 0}) < 1e-3);
    }
  }
}

TEST_CASE("a pin that is lifted carries the weight of what is tethered to it") {
  const double mass = 2, speed = 0.5;
  for (const double rate : kRates) {
    Cloth cloth = cloth_of(pendulum({0, -1, 0}, mass), {});
    double work = 0;
    for (int frame = 1; frame <= rate; ++frame) {
      REQUIRE(cloth.move_fixed(0, {0, speed * frame / rate, 0}));
      const StepReport report = step(cloth, 1 / rate);
      CHECK(report.status == Status::converged);
      if (2 * frame > rate) work += report.pin_work;
    }
    CAPTURE(rate);
    CHECK(cloth.position(1).y == doctest::Approx(speed - 1).epsilon(1e-3));
    CHECK(work / (speed / 2) == doctest::Approx(mass * 10).epsilon(0.01));  // N
  }
}

/// Runs it for a second, with tethers and without: the largest excess of each.
std::array<double, 2> excesses(SceneDescription scene, std::uint32_t size, Backend backend,
                               double rate) {
  const Settings settings{.tolerance = 0.03, .backend = backend};
  Cloth held = cloth_of(scene, settings);
  CHECK(describe(*held.model()).tethers == size * (size - 1));
  scene.tether_slack = kUntethered;
  Cloth loose = cloth_of(scene, settings);
  std::array<double, 2> most{};
  for (int frame = 0; frame < rate; ++frame) {
    CHECK(step(held, 1 / rate).status == Status::converged);
    step(loose, 1 / rate);
    most[0] = std::max(most[0], largest_excess(held, size));
    most[1] = std::max(most[1], largest_excess(loose, size));
  }
  return most;
}

TEST_CASE(
    "no particle of a tethered sheet is farther from its pin than the cloth between is long") {
  for (const Backend backend : kBackends) {
    for (const std::uint32_t size : {9u, 20u}) {
      for (const double rate : kRates) {
        for (const SceneDescription& scene :
             {sheet(size, "wool", 200, 0), sheet(size, "silk", 60, 0)}) {
          CAPTURE(size);
          CAPTURE(rate);
          const auto [held, loose] = excesses(scene, size, backend, rate);
          CHECK(held < 1.01 * Settings{}.contact_tolerance);
          CHECK(loose > 10 * Settings{}.contact_tolerance);
        }
      }
    }
  }
}

TEST_CASE("a tether of a pin that is released is off, and the nearest pin that is left counts") {
  SceneDescription scene;  // three in a row, 1 m apart, and pins at both ends
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
  scene.masses = {1, 1, 1};
  scene.constraints = {{0, 1, 1, ConstraintKind::rope}, {1, 2, 2, ConstraintKind::rope}};
  scene.fixed = {0, 2};
  scene.tether_slack = 0.5;
  Cloth nearest = cloth_of(scene, {});
  REQUIRE(nearest.change({.release = {0}}));
  CHECK(describe(*nearest.model()).tethers == 2);  // of 1.5 times 2 and 3 m
  scene.constraints.clear();
  scene.tether_slack = kUntethered;
  scene.tethers = {{1, 0, 1.5}};
  Cloth cloth = cloth_of(scene, {});
  run(cloth, 0.01, 100);
  CHECK(distance(cloth.position(1), cloth.position(0)) < 1.5 + 1e-4);
  REQUIRE(cloth.change({.release = {0}}));
  CHECK(describe(*cloth.model()).tethers == 0);
  const Vec3 apart = cloth.position(1) - cloth.position(0);
  run(cloth, 0.01, 50);
  CHECK(cloth.position(0).y < -1);
  REQUIRE(cloth.change({.fix = {0}}));
  CHECK(describe(*cloth.model()).tethers == 1);
  CHECK(length(apart) > 0);
}

TEST_CASE("a tethered sheet goes on when some of its pins are released and fixed again") {
  const std::uint32_t size = 20;
  const std::vector<std::uint32_t> some{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  for (const Backend backend : kBackends) {
    Cloth cloth = cloth_of(sheet(size, "wool", 200, 0.02), {.backend = backend});
    run(cloth, 1. / 60, 30);
    for (int i = 0; i < 2; ++i) {
      REQUIRE(cloth.change({.release = some}));
      CHECK(describe(*cloth.model()).tethers == size * (size - 1) + some.size());
      run(cloth, 1. / 60, 10);
      REQUIRE(cloth.change({.fix = some}));
      CHECK(describe(*cloth.model()).tethers == size * (size - 1));
      run(cloth, 1. / 60, 10);
    }
    CHECK(step(cloth, 1. / 60).status == Status::converged);
  }
}

TEST_CASE("tethers go on from saved bytes, in C and in copies, bit for bit") {
  SceneDescription scene = sheet(9, "wool", 200, 0.01);
  scene.tethers = {{.particle = 80, .pin = 0, .length = 1.3}};
  const c_interface::SceneArrays arrays = c_interface::arrays_of(scene);
  const weft_scene in_c = c_interface::scene_of(scene, arrays);
  const auto again = c_interface::read_scene(&in_c);
  REQUIRE(again);
  CHECK(again.value().tether_slack == 0.01);
  REQUIRE(again.value().tethers.size() == 1);
  CHECK(again.value().tethers[0].length == 1.3);
  Cloth cloth = cloth_of(scene, {}), of_c = cloth_of(again.value(), {});
  const auto saved_model = load_model(save_model(*cloth.model()));
  REQUIRE(saved_model);
  const auto frame = [](Cloth& it, int i) {
    REQUIRE(it.move_fixed(0, {0, 0.002 * i, 0}));
    step(it, 1. / 60);
    return it.state_hash();
  };
  for (int i = 1; i <= 20; ++i) CHECK(frame(cloth, i) == frame(of_c, i));
  auto other = Cloth::create(saved_model.value(), {});
  REQUIRE(other);
  REQUIRE(other.value().load_state(cloth.save_state()));
  Cloth copy = cloth.clone();
  for (int i = 21; i <= 40; ++i) {
    const std::uint64_t hash = frame(cloth, i);
    CHECK(frame(other.value(), i) == hash);
    CHECK(frame(copy, i) == hash);
  }
}

TEST_CASE("a tether that cannot be is named") {
  const auto error = [](const std::vector<Tether>& tethers, double slack = kUntethered) {
    SceneDescription scene = pendulum({0, -1, 0});
    scene.positions.push_back({1, 0, 0});
    scene.masses.push_back(1);
    scene.anchors = {{.particle = 2, .point = {1, 0, 0}, .max_distance = 1}};
    scene.tethers = tethers;
    scene.tether_slack = slack;
    const auto model = build_model(scene);
    return model ? std::string() : model.error();
  };
  CHECK(error({{1, 0, 1}}) == "");
  CHECK(error({{1, 7, 1}}) == "tethers[0].pin: no such particle, the scene has 3 (7)");
  CHECK(error({{1, 1, 1}}) == "tethers[0]: ties a particle to itself (1)");
  CHECK(error({{1, 0, 0}}) == "tethers[0].length: must be finite and greater than 0 (0)");
  CHECK(error({{1, 0, 1}, {1, 0, 2}}) == "tethers[1].particle: has a tether already (1)");
  CHECK(error({{2, 0, 1}}) == "tethers[0].particle: has an anchor (2)");
  CHECK(error({}, -0.1) == "tether_slack: must be at least 0, or infinite (-0.1)");
  const auto refused = Cloth::create(model_of(pendulum({0, -1, 0})), {.solver = Solver::yarn});
  REQUIRE(!refused);
  CHECK(refused.error() == "tethers: is solved by small_steps only (yarn)");
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_tethers
