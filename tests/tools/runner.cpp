#include "tools/runner.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "engine/scenes.h"

namespace weft::tools {
namespace {

SceneDescription hang(int size) { return scenes::make("hang", {.size = size}).value(); }

TEST_CASE("a summary sums up what the steps reported and what the cloth measured") {
  const SceneDescription scene = hang(6);
  RunSummary expected;
  double strain_sum = 0;
  double square_sum = 0;
  const auto summary =
      run(scene, {}, {.steps = 30}, [&](int frame, const Cloth& cloth, const StepReport& report) {
        CHECK(frame == ++expected.frames);
        expected.iterations += report.iterations;
        expected.visits += report.visits;
        expected.corrections += report.corrections;
        expected.direction_updates += report.direction_updates;
        const Strain strain = cloth.strain();
        expected.max_strain = std::max(expected.max_strain, strain.max);
        strain_sum += strain.max;
        square_sum += strain.rms * strain.rms;
        expected.state_hash = cloth.state_hash();
        expected.energy_end = cloth.energy().total();
      });
  REQUIRE(summary);
  const RunSummary& actual = summary.value();
  CHECK(actual.frames == 30);
  CHECK(actual.status == Status::converged);
  CHECK(actual.iterations == expected.iterations);
  CHECK(actual.visits == expected.visits);
  CHECK(actual.corrections == expected.corrections);
  CHECK(actual.direction_updates == expected.direction_updates);
  CHECK(actual.max_strain == expected.max_strain);
  CHECK(actual.mean_max_strain == strain_sum / 30);
  CHECK(actual.rms_strain == doctest::Approx(std::sqrt(square_sum / 30)));
  CHECK(actual.state_hash == expected.state_hash);
  CHECK(actual.energy_end == expected.energy_end);
  CHECK(actual.step_seconds > 0);
  CHECK(actual.solver_seconds <= actual.step_seconds);
  double other_stages = 0;
  for (std::size_t i = 0; i < kStageCount; ++i) {
    if (static_cast<Stage>(i) != Stage::report) other_stages += actual.stage_seconds[i];
  }
  CHECK(actual.solver_seconds == other_stages);
  CHECK(actual.model.particles == 36);
}

TEST_CASE("a summary tells of halves, contacts and memory") {
  const SceneDescription corners = scenes::make("corners", {.size = 21}).value();
  const SceneDescription sphere = scenes::make("hang_sphere", {.size = 9}).value();
  for (const SceneDescription* scene : {&corners, &sphere}) {
    RunSummary expected;
    const auto summary =
        run(*scene, {.substeps = 1, .solver = Solver::yarn}, {.dt = 0.05, .steps = 12},
            [&](int, const Cloth& cloth, const StepReport& report) {
              expected.halvings += report.halvings;
              expected.max_contacts = std::max(expected.max_contacts, report.contacts);
              expected.bytes = cloth.bytes() + describe(*cloth.model()).bytes;
            });
    REQUIRE(summary);
    CHECK((scene == &corners ? expected.halvings : expected.max_contacts) > 0);
    CHECK(summary.value().halvings == expected.halvings);
    CHECK(summary.value().max_contacts == expected.max_contacts);
    CHECK(summary.value().bytes == expected.bytes);
  }
}

TEST_CASE("where energy was only lost the largest gain is the smallest loss") {
  SceneDescription bar;
  bar.positions = {{0, 0, 0}, {1, 0, 0}};
  bar.velocities = {{-1, 0, 0}, {1, 0, 0}};
  bar.masses = {1, 1};
  bar.gravity = {0, 0, 0};
  bar.constraints = {{0, 1, 1}};
  const auto summary = run(bar, {}, {.steps = 3});
  REQUIRE(summary);
  CHECK(summary.value().energy_start == 1);
  CHECK(summary.value().energy_gain < -0.9);
}

TEST_CASE("repeats differ in nothing but their time, and only the first is shown") {
  const SceneDescription scene = hang(5);
  int shown = 0;
  const auto once = run(scene, {}, {.steps = 10});
  const auto best = run(scene, {}, {.steps = 10, .repeat = 3},
                        [&](int, const Cloth&, const StepReport&) { ++shown; });
  REQUIRE(once);
  REQUIRE(best);
  CHECK(shown == 10);
  CHECK(best.value().frames == 10);
  CHECK(best.value().state_hash == once.value().state_hash);
  CHECK(best.value().visits == once.value().visits);
}

TEST_CASE("where a repeat is stopped the best run before it is reported, whole") {
  const SceneDescription scene = hang(5);
  constexpr int kSteps = 10;
  const auto whole = run(scene, {}, {.steps = kSteps});
  REQUIRE(whole);
  for (const int finished : {0, 1, 3}) {
    CAPTURE(finished);
    int asked = 0;
    const auto stop = [&] { return ++asked >= finished * kSteps + 4; };
    const auto stopped = run(scene, {}, {.steps = kSteps, .repeat = 5, .stop = stop});
    REQUIRE(stopped);
    CHECK(stopped.value().stopped);
    CHECK(stopped.value().finished_runs == finished);
    CHECK(stopped.value().frames == (finished == 0 ? 4 : kSteps));
    CHECK((stopped.value().state_hash == whole.value().state_hash) == (finished > 0));
  }
  CHECK_FALSE(whole.value().stopped);
  CHECK(whole.value().finished_runs == 1);
}

TEST_CASE("the worst status of all frames is told") {
  const SceneDescription scene = hang(8);
  const auto limited = run(scene, {.tolerance = 1e-9, .max_iterations = 2}, {.steps = 5});
  REQUIRE(limited);
  CHECK(limited.value().status == Status::iteration_limit);
  CHECK_FALSE(limited.value().reached_tolerance());
  REQUIRE(limited.value().first_miss);
  CHECK(limited.value().first_miss->frame == 1);
  CHECK(limited.value().first_miss->status == Status::iteration_limit);
  CHECK(limited.value().first_miss->constraint < scene.constraints.size());
  const auto fixed = run(scene, {.iterations = 2}, {.steps = 5});
  REQUIRE(fixed);
  CHECK(fixed.value().status == Status::fixed_iterations);
  CHECK(fixed.value().iterations == 10);
  CHECK(fixed.value().reached_tolerance());
}

TEST_CASE("a run ends with the frame that would not be finite") {
  const auto summary = run(hang(4), {}, {.dt = 1e200, .steps = 5});
  REQUIRE(summary);
  CHECK(summary.value().status == Status::non_finite_input);
  CHECK(summary.value().frames == 1);
  CHECK_FALSE(summary.value().reached_tolerance());
  CHECK(text(*summary.value().first_miss).starts_with("frame 1: non_finite_input at particle "));
}

TEST_CASE("a miss names what its report names") {
  const Miss limit{
      .frame = 3, .status = Status::iteration_limit, .max_strain = 0.021, .constraint = 7};
  CHECK(text(limit) == "frame 3: iteration_limit; constraint 7 has the largest strain, 2.1 %");
  const Miss deep{.frame = 3, .status = Status::infeasible, .max_penetration = 0.02};
  CHECK(text(deep) == "frame 3: infeasible; contacts are up to 0.02 m deep");
  const Miss passed{
      .frame = 9, .status = Status::passed_through, .constraint = 7, .passed_particle = 4};
  CHECK(text(passed) == "frame 9: passed_through; particle 4 went through a sphere");
}

TEST_CASE("what the library refuses is passed on") {
  CHECK_FALSE(run(SceneDescription{}, {}, {}));
  CHECK_FALSE(run(hang(3), {.tolerance = -1}, {}));
  CHECK_FALSE(run(hang(3), {}, {.dt = -1}));
}

}  // namespace
}  // namespace weft::tools
