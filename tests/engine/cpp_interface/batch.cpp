/// Cloths that are stepped together move as each does alone, and fail each for itself.
#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/job_systems.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/random_cases.h"
#include "tests/support/teams.h"

namespace weft::test::engine_cpp_interface_batch {
namespace {

#ifdef WEFT_SANITIZE_THREAD
constexpr std::uint32_t kCases = 7;
constexpr int kFrames = 2;
#else
constexpr std::uint32_t kCases = 60;
constexpr int kFrames = 3;
#endif

struct Clothes {
  std::vector<Cloth> cloths;
  std::vector<double> dt;

  Clothes clone() const {
    Clothes copy;
    for (const Cloth& cloth : cloths) copy.cloths.push_back(cloth.clone());
    copy.dt = dt;
    return copy;
  }
};

void add(Clothes& all, const SceneDescription& scene, const Settings& settings, double dt,
         const std::vector<Vec3>& forces = {}) {
  all.cloths.push_back(cloth_of(scene, settings));
  REQUIRE(all.cloths.back().write_forces(forces));
  all.dt.push_back(dt);
}

/// Small ones of any kind and settings, and between them some that are worth several threads.
Clothes many_clothes() {
  Clothes all;
  for_each_case(kCases, random_case, [&](const RandomCase& c) {
    add(all, c.scene, c.settings, c.dt, c.forces);
    if (c.seed % 7 == 0) all.cloths.push_back(all.cloths.back().clone()), all.dt.push_back(c.dt);
  });
  for_each_case(kCases / 3, softened_case,
                [&](const RandomCase& c) { add(all, c.scene, c.settings, c.dt, c.forces); });
  for_each_case(kCases / 3, fabric_case,
                [&](const RandomCase& c) { add(all, c.scene, c.settings, c.dt, c.forces); });
  add(all, scene_of("hang", 64), {}, 0.01);
  add(all, scene_of("hang_sphere", 50), {.solver = Solver::yarn}, 0.005);
  add(all, roped_sheet(48), {.threads = 1}, 0.01);
  add(all, random_sheet(46, 5), {.solver = Solver::small_steps, .threads = 2}, 0.01);
  return all;
}

/// What steps come to: the state, and what the report counts and measures.
struct Outcome {
  std::uint64_t hash = 0;
  Status status = Status::converged;
  std::int64_t iterations = 0;
  double max_strain = 0;

  Outcome() = default;
  Outcome(const Cloth& cloth, const StepReport& report)
      : hash(cloth.state_hash()),
        status(report.status),
        iterations(report.iterations),
        max_strain(report.max_strain) {}
  bool operator==(const Outcome&) const = default;
};

std::vector<Outcome> alone(Clothes all) {
  std::vector<Outcome> outcomes(all.cloths.size());
  for (std::size_t i = 0; i < all.cloths.size(); ++i) {
    for (int k = 0; k < kFrames; ++k) outcomes[i] = {all.cloths[i], step(all.cloths[i], all.dt[i])};
  }
  return outcomes;
}

std::vector<ClothStep> steps_of(Clothes& all) {
  std::vector<ClothStep> steps;
  for (std::size_t i = 0; i < all.cloths.size(); ++i)
    steps.push_back({.cloth = &all.cloths[i], .dt = all.dt[i]});
  return steps;
}

std::vector<Outcome> together(Clothes all, const JobSystem& jobs) {
  std::vector<ClothStep> steps = steps_of(all);
  for (int k = 0; k < kFrames; ++k) step_all(steps, jobs);
  std::vector<Outcome> outcomes;
  for (const ClothStep& step : steps) {
    REQUIRE_MESSAGE(step.result, step.result.error());
    outcomes.emplace_back(*step.cloth, step.result.value());
  }
  return outcomes;
}

TEST_CASE("each cloth of a batch is what it is alone, bit for bit, whoever runs its jobs") {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 4);
  const Clothes clothes = many_clothes();
  const std::vector<Outcome> expected = alone(clothes.clone());
  CHECK(together(clothes.clone(), {}) == expected);
  for (const int threads : {1, 2, 4}) {
    CAPTURE(threads);
    std::vector<Outcome> found;
    in_arena(threads, [&] { found = together(clothes.clone(), {}); });
    CHECK(found == expected);
  }
  for_each_host(2, [&](const std::string& name, const JobSystem& jobs) {
    CAPTURE(name);
    CHECK(together(clothes.clone(), jobs) == expected);
  });
  Pool pool(4);
  CHECK(together(clothes.clone(), pool.jobs()) == expected);
}

TEST_CASE("so is a single step by the jobs of a host") {
  const auto run_with = [](const JobSystem& jobs) {
    Cloth cloth = cloth_of(scene_of("hang", 64), {});
    for (int k = 0; k < 5; ++k) CHECK(cloth.step(0.01, jobs));
    return cloth.state_hash();
  };
  const std::uint64_t expected = run_with({});
  for (const int threads : {1, 2, 4}) {
    for_each_host(threads, [&](const std::string& name, const JobSystem& jobs) {
      CAPTURE(name);
      CHECK(run_with(jobs) == expected);
    });
  }
}

TEST_CASE("a batch of none, and one that is stepped twice") {
  step_all({});
  Cloth cloth = cloth_of(scene_of("hang", 6), {}), other = cloth.clone();
  ClothStep steps[]{{&cloth, 0.01}};
  for (int k = 0; k < 2; ++k) {
    step_all(steps);
    CHECK(steps[0].result);
    step(other, 0.01);
  }
  CHECK(cloth.state_hash() == other.state_hash());
}

/// What each fails with in a batch, and that the others are stepped nevertheless.
void check_failures(const JobSystem& jobs) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Cloth> cloths;
  for (int k = 0; k < 7; ++k) cloths.push_back(cloth_of(scene_of("hang", 8), {}));
  const Cloth moved_to = std::move(cloths[1]);
  const std::vector<Vec3> too_much(cloths[6].particle_count(), Vec3{1e308, 0, 0});
  REQUIRE(cloths[6].write_forces(too_much));
  const std::uint64_t start = cloths[0].state_hash();
  std::vector<ClothStep> steps{{&cloths[0], 0.01}, {nullptr, 0.01},      {&cloths[1], 0.01},
                               {&cloths[2], -1},   {&cloths[3], kNan},   {&cloths[0], 0.02},
                               {&cloths[4], 0.01}, {&cloths[5], 1e-320}, {&cloths[6], 0.01}};
  for (int frame = 0; frame < 2; ++frame) {  // a failure leaves nothing behind
    step_all(steps, jobs);
    CHECK(steps[1].result.error() == "steps[1].cloth: must not be null (null)");
    CHECK(steps[2].result.error() == "steps[2].cloth: was moved from (empty)");
    CHECK(steps[3].result.error() == "steps[3].dt: must be finite and greater than 0 (-1)");
    CHECK(steps[4].result.error() == "steps[4].dt: must be finite and greater than 0 (nan)");
    CHECK(steps[5].result.error() == "steps[5].cloth: is in the batch already (twice)");
    CHECK(steps[7].result.error().starts_with("steps[7].dt: is too small"));
    REQUIRE(steps[8].result);
    CHECK(steps[8].result.value().status == Status::non_finite_input);
    REQUIRE((steps[0].result && steps[6].result));
  }
  for (const std::size_t i : {2u, 3u, 5u, 6u}) CHECK(cloths[i].state_hash() == start);
  Cloth expected = cloth_of(scene_of("hang", 8), {});
  run(expected, 0.01, 2);
  CHECK(cloths[0].state_hash() == expected.state_hash());
  CHECK(cloths[4].state_hash() == expected.state_hash());
  steps[3].dt = 0.01;
  step_all(steps, jobs);
  CHECK(steps[3].result);
}

TEST_CASE("who fails does not keep the others from their step, and says so") {
  check_failures({});
  for_each_host(2, [](const std::string& name, const JobSystem& jobs) {
    CAPTURE(name);
    check_failures(jobs);
  });
}

TEST_CASE("half a job system is refused") {
  Pool pool(2);
  for (const bool without_run : {false, true}) {
    JobSystem half = pool.jobs();
    without_run ? void(half.run = nullptr) : void(half.threads = nullptr);
    Cloth cloth = cloth_of(scene_of("hang", 6), {});
    const std::uint64_t start = cloth.state_hash();
    const std::string expected = std::string("jobs: must have both functions or neither (") +
                                 (without_run ? "threads)" : "run)");
    const auto report = cloth.step(0.01, half);
    CHECK((!report && report.error() == expected));
    ClothStep steps[]{{&cloth, 0.01}};
    step_all(steps, half);
    CHECK((!steps[0].result && steps[0].result.error() == expected));
    CHECK(cloth.state_hash() == start);
  }
}

}  // namespace
}  // namespace weft::test::engine_cpp_interface_batch
