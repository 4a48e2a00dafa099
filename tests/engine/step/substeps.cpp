/// Substeps: many small steps that answer as one.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "engine/isa.h"
#include "engine/parallel/team.h"
#include "engine/step/plan.h"
#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"
#include "tools/scenes/scenes.h"

namespace weft::test::engine_step_substeps {
namespace {

Settings in_substeps(Settings settings, int substeps) {
  settings.substeps = substeps;
  return settings;
}

void add(StepReport& sum, const StepReport& report) {
  sum.status = std::max(sum.status, report.status);
  sum.iterations += report.iterations;
  sum.direction_updates += report.direction_updates;
  sum.velocity_iterations += report.velocity_iterations;
  sum.visits += report.visits;
  sum.corrections += report.corrections;
  sum.contacts = report.contacts;
  sum.max_strain = report.max_strain;
  sum.rms_strain = report.rms_strain;
  sum.max_penetration = report.max_penetration;
}

void check_equal(const StepReport& report, const StepReport& expected) {
  CHECK(report.status == expected.status);
  CHECK(report.iterations == expected.iterations);
  CHECK(report.direction_updates == expected.direction_updates);
  CHECK(report.velocity_iterations == expected.velocity_iterations);
  CHECK(report.visits == expected.visits);
  CHECK(report.corrections == expected.corrections);
  CHECK(report.contacts == expected.contacts);
  CHECK(report.max_strain == expected.max_strain);
  CHECK(report.rms_strain == expected.rms_strain);
  CHECK(report.max_penetration == expected.max_penetration);
}

TEST_CASE("automatic substeps end at 1024 a step") {
  Cloth cloth = cloth_of(scene_of("hang", 5), {});
  CHECK(step(cloth, 100).substeps == 1024);
}

TEST_CASE("automatic substeps by yarns leave each at least eight of the step's iterations") {
  Team team;
  for (const int most : {1, 40, 400}) {
    State s(
        model_of(scene_of("hang", 5)),
        {.max_iterations = most, .solver = Solver::yarn, .isa = resolve(Isa::automatic).value()});
    StepReport report;
    CHECK(plan_for(s, 100, report, team).substeps == std::max(1, most / 8));
  }
}

/// Of a sheet of 1 kg that hangs by one side, with a load at a free corner, in its first step.
int substeps_under(double load, const Settings& settings, double gravity = 10) {
  constexpr int kSize = 12;
  SceneDescription scene = scene_of("hang", kSize);
  scene.gravity = {0, -gravity, 0};
  const bool first_is_fixed = scene.fixed[0] == 0;
  scene.masses[first_is_fixed ? scene.masses.size() - 1 : 0] *= load;
  Cloth cloth = cloth_of(scene, settings);
  return step(cloth, 0.01).substeps;
}

TEST_CASE("automatic substeps of yarns follow a load, as its root") {
  const double once = 0.7 * 0.01 * std::sqrt(10 * 11.0);  // links of 1 / 11 m
  CHECK(substeps_under(900, {}) == 1);
  for (const double load : {2e3, 1e4, 1e5}) {
    CAPTURE(load);
    CHECK(substeps_under(load, {}) == static_cast<int>(std::ceil(once * std::sqrt(load))));
    CHECK(substeps_under(load, {.solver = Solver::direct}) == 1);
  }
}

TEST_CASE("and gravity, as its root") {
  for (const double gravity : {1.62, 24.8}) {
    CAPTURE(gravity);
    const double wanted = 0.7 * 0.01 * std::sqrt(gravity * 11.0 * 1e5);
    CHECK(substeps_under(1e5, {}, gravity) == static_cast<int>(std::ceil(wanted)));
  }
}

TEST_CASE("sheets and chains under loads converge, and soon") {
  const struct {
    const char* scene;
    int size;
    double load;
    int most_iterations;                 // of a step
  } kLoads[] = {{"hang", 12, 1e4, 100},  // 13,000 in substeps that the motion alone wants
                {"hang", 12, 1e5, 1000},
                {"chain", 20, 1e4, 100}};
  for (const auto& [name, size, load, most_iterations] : kLoads) {
    CAPTURE(std::string(name));
    CAPTURE(load);
    SceneDescription scene = scene_of(name, size);
    scene.masses.back() *= load;
    REQUIRE(scene.fixed[0] == 0);
    Cloth cloth = cloth_of(scene, {.solver = Solver::yarn});
    const double start = cloth.energy().total();
    for (int k = 0; k < 100; ++k) {
      const StepReport report = step(cloth, 0.01);
      REQUIRE(report.status == Status::converged);
      REQUIRE(report.iterations < most_iterations);
    }
    CHECK(cloth.energy().total() < start);
  }
}

SceneDescription dropped(double mass) {
  scenes::Options options;
  options.sphere_mass = mass;
  return scenes::make("sphere_drop", options).value();
}

/// Of sphere_drop, 20 x 20, in steps of 0.01 s.
int substeps_under_sphere(double mass) {
  const double length = 1.0 / 19, particle = 1.0 / 400;
  return static_cast<int>(std::ceil(0.7 * 0.01 * std::sqrt(10 * mass / particle / length)));
}

TEST_CASE("spheres are loads from where they touch on") {
  Cloth cloth = cloth_of(dropped(100), {});
  CHECK(step(cloth, 0.01).substeps < 4);
  int touches = 0;
  for (int k = 0; k < 100; ++k) {
    const StepReport report = step(cloth, 0.01);
    REQUIRE(report.status == Status::converged);  // without: infeasible, sweeps by the million
    if (report.contacts == 0) continue;
    ++touches;
    CHECK(report.substeps >= substeps_under_sphere(100));
    CHECK(report.iterations < 20'000);
  }
  CHECK(touches > 50);
}

/// Of a level sheet on which two spheres lie, in its first step.
int substeps_under_spheres(double first_mass, double second_mass) {
  constexpr double kRadius = 0.1;
  SceneDescription scene = scene_of("hang", 12);
  scene.radii.assign(scene.positions.size(), 0);
  for (const auto& [below, mass] : {std::pair{75, first_mass}, std::pair{80, second_mass}}) {
    scene.spheres.push_back(static_cast<std::uint32_t>(scene.positions.size()));
    scene.positions.push_back(scene.positions[static_cast<std::size_t>(below)] +
                              Vec3{0, kRadius, 0});
    scene.masses.push_back(mass);
    scene.radii.push_back(kRadius);
  }
  Cloth cloth = cloth_of(scene, {});
  return step(cloth, 0.01).substeps;
}

TEST_CASE("of several spheres the heaviest is the load, whatever their order") {
  const double wanted = std::ceil(0.7 * 0.01 * std::sqrt(10 * 100 * 144 * 11.0));
  CHECK(substeps_under_spheres(100, 0.01) == static_cast<int>(wanted));
  CHECK(substeps_under_spheres(0.01, 100) == static_cast<int>(wanted));
}

TEST_CASE("spheres are no loads with scheme rattle") {
  Cloth rattle = cloth_of(dropped(10), {.scheme = Scheme::rattle});
  int least = 100;
  for (int k = 0; k < 60; ++k) {
    const StepReport report = step(rattle, 0.01);
    if (report.contacts > 0) least = std::min(least, report.substeps);
  }
  CHECK(least < substeps_under_sphere(10));
}

/// Of a sheet that is far wider than high, level at first, over 30 steps.
int most_substeps(bool hung_by_its_length) {
  constexpr std::uint32_t kLong = 300, kHigh = 4;
  SceneDescription scene;
  for (std::uint32_t i = 0; i < kLong * kHigh; ++i) {
    const std::uint32_t along = i / kHigh, across = i % kHigh;
    scene.positions.push_back({0.01 * along, 0, 0.01 * across});
    scene.masses.push_back(1e-4);
    if (along > 0) scene.constraints.push_back({i - kHigh, i, 0.01});
    if (across > 0) scene.constraints.push_back({i - 1, i, 0.01});
    if ((hung_by_its_length ? across : along) == 0) scene.fixed.push_back(i);
  }
  Cloth cloth = cloth_of(scene, {.scheme = Scheme::paper});
  int most = 0;
  for (int k = 0; k < 30; ++k) most = std::max(most, step(cloth, 0.01).substeps);
  return most;
}

TEST_CASE("what bends counts by the yarns that it is on: a curtain is no flag") {
  CHECK(most_substeps(true) <= 2);  // 5 by its longest
  CHECK(most_substeps(false) == 3);
}

TEST_CASE("a step in substeps is so many small steps, and reports their sum") {
  for (const Backend backend : kBackends) {
    for (const char* name : {"hang", "hang_sphere", "sphere_drop"}) {
      for (const bool velocity_correction : {false, true}) {
        CAPTURE(std::string(weft::name(backend)));
        CAPTURE(std::string(name));
        CAPTURE(velocity_correction);
        Settings settings = on(backend);
        settings.velocity_correction = velocity_correction;
        const SceneDescription scene = scene_of(name, 7);
        Cloth whole = cloth_of(scene, in_substeps(settings, 3));
        Cloth small = cloth_of(scene, settings);
        for (int frame = 0; frame < 40; ++frame) {
          const StepReport report = step(whole, 0.01);
          StepReport sum;
          for (int k = 0; k < 3; ++k) add(sum, step(small, 0.01 / 3));
          check_equal(report, sum);
          REQUIRE(whole.state_hash() == small.state_hash());
        }
      }
    }
  }
}

TEST_CASE("the status is the worst of the substeps") {
  Settings settings = on(each_backend(), tight(1e-9));
  settings.max_iterations = 16;
  Cloth cloth = cloth_of(scene_of("hang", 7), in_substeps(settings, 4));
  const StepReport report = step(cloth, 0.01);
  CHECK(report.status == Status::iteration_limit);
  CHECK(report.iterations == 16);
}

// Each substep may do one for each of its parts (report.substeps), by each scheme.
TEST_CASE("the bound on iterations is that of the step, whatever its substeps") {
  constexpr int kMost = 2000;
  Settings settings = on(each_backend(), tight(1e-12));
  settings.max_iterations = kMost;
  settings.velocity_correction = true;
  for (const Solver solver : {Solver::gauss_seidel, Solver::yarn, Solver::direct}) {
    for (const Scheme scheme : {Scheme::paper, Scheme::rattle}) {
      for (const int substeps : {kAutomaticSubsteps, 1, 8, 60}) {
        if (settings.backend == Backend::reference && solver == Solver::yarn) continue;
        CAPTURE(std::string(name(solver)));
        CAPTURE(std::string(name(scheme)));
        CAPTURE(substeps);
        settings.solver = solver;
        settings.scheme = scheme;
        Cloth cloth = cloth_of(scene_of("corners", 9), in_substeps(settings, substeps));
        for (int k = 0; k < 5; ++k) {
          const StepReport report = step(cloth, 0.02);
          CHECK(report.iterations <= kMost + 2 * report.substeps);
          CHECK(report.velocity_iterations <= kMost + 2 * report.substeps);
        }
      }
    }
  }
}

TEST_CASE("what projects a start is of the iterations of its step") {
  constexpr int kMost = 100;
  SceneDescription scene;  // four links, their ends too far apart
  for (std::uint32_t i = 0; i < 5; ++i) {
    scene.positions.push_back({1.1 * i, 0, 0});
    scene.masses.push_back(1);
    if (i > 0) scene.constraints.push_back({i - 1, i, 1});
  }
  scene.fixed = {0, 4};
  for (const Solver solver : {Solver::gauss_seidel, Solver::yarn}) {
    CAPTURE(std::string(name(solver)));
    Cloth cloth = cloth_of(scene, {.substeps = 1, .max_iterations = kMost, .solver = solver});
    const StepReport report = step(cloth, 0.01);
    CHECK(report.status == Status::iteration_limit);
    CHECK(report.iterations <= kMost);
  }
}

// A ring of particles in a sphere that stands still, of which a bar joins two: nearly all that is
// visited are contacts. What was begun is completed: the projection, the sweeps and the passes of
// the substep, and a round end at most one iteration each beyond the bound.
TEST_CASE("an iteration of small steps is once over all constraints and contacts") {
  constexpr std::uint32_t kRing = 40;
  constexpr int kMost = 4;
  SceneDescription scene;
  for (std::uint32_t i = 0; i < kRing; ++i) {
    const double angle = 2 * 3.141592653589793 * i / kRing;
    scene.positions.push_back({0.9 * std::cos(angle), 0, 0.9 * std::sin(angle)});
  }
  scene.positions.push_back({});
  scene.masses.assign(kRing + 1, 1);
  scene.radii.assign(kRing + 1, 0);
  scene.radii[kRing] = 1;
  scene.spheres = {kRing};
  scene.fixed = {kRing};
  scene.constraints = {{0, 1, 0.15, ConstraintKind::distance}};
  for (const Backend backend : {Backend::reference, Backend::simd}) {
    CAPTURE(std::string(name(backend)));
    Settings settings{.max_iterations = kMost, .solver = Solver::small_steps, .backend = backend};
    Cloth cloth = cloth_of(scene, in_substeps(settings, 1));
    const StepReport report = step(cloth, 0.01);
    CHECK(report.contacts == static_cast<int>(kRing));
    CHECK(report.visits >= kRing);
    CHECK(report.iterations <= kMost + 4);
  }
}

TEST_CASE("a fixed number of iterations is that of each substep") {
  Settings settings = on(each_backend());
  settings.iterations = 5;
  Cloth cloth = cloth_of(scene_of("hang", 7), in_substeps(settings, 4));
  const StepReport report = step(cloth, 0.01);
  CHECK(report.status == Status::fixed_iterations);
  CHECK(report.iterations == 20);
  CHECK(report.direction_updates == 4);
}

// Flying at 3e149 m/s for 8 s: beyond 1e150 m, three substeps in, a state no longer counts as
// finite.
SceneDescription on_the_way_to_overflow() {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 2, 3}};
  scene.velocities = {{3e149, 0, 0}, {1, 0, 0}};
  scene.masses = {1, 1};
  return scene;
}

TEST_CASE("a later substep that overflows takes the whole step back") {
  const Backend backend = each_backend();
  {
    Cloth small = cloth_of(on_the_way_to_overflow(), on(backend));
    REQUIRE(step(small, 1).status == Status::converged);
    REQUIRE(step(small, 1).status == Status::converged);
  }
  Cloth cloth = cloth_of(on_the_way_to_overflow(), in_substeps(on(backend), 8));
  const std::uint64_t before = cloth.state_hash();
  for (int attempt = 0; attempt < 2; ++attempt) {
    const StepReport report = step(cloth, 8);
    CHECK(report.status == Status::non_finite_input);
    CHECK(report.substeps == 0);
    CHECK(cloth.state_hash() == before);
  }
  REQUIRE(cloth.write_velocities(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}}));
  CHECK(step(cloth, 8).status == Status::converged);
  CHECK(distance(cloth.position(1), {9, 2 - 320, 3}) < 1e-9);
}

TEST_CASE("the number of substeps must be at least 0") {
  for (const int substeps : {-1, -2}) {
    const auto cloth =
        Cloth::create(model_of(scene_of("hang", 4)), in_substeps(paper_settings(), substeps));
    REQUIRE_FALSE(cloth);
    CHECK(cloth.error().find("substeps") != std::string::npos);
    CHECK(cloth.error().find(std::to_string(substeps)) != std::string::npos);
  }
}

}  // namespace
}  // namespace weft::test::engine_step_substeps
