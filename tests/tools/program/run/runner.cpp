#include "tools/program/run/runner.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "tests/tools/slowness.h"
#include "tools/program/run/step_total.h"
#include "tools/scenes/scenes.h"

namespace weft::tools {
namespace {

SceneDescription hang(int size) { return scenes::make("hang", {.size = size}).value(); }

/// The frames of a run, summed up here once more.
struct Frames {
  RunSummary sums;
  double strain_sum = 0, square_sum = 0;
  double lowest_y = 0;  ///< in the last one
  StepReport last;

  void add(const Cloth& cloth, const StepReport& report) {
    ++sums.frames;
    sums.total.substeps += report.substeps;
    sums.total.halvings += report.halvings;
    sums.total.iterations += report.iterations;
    sums.total.velocity_iterations += report.velocity_iterations;
    sums.total.direction_updates += report.direction_updates;
    sums.total.visits += report.visits;
    sums.total.corrections += report.corrections;
    sums.total.scheme_fallbacks += report.scheme_fallbacks;
    sums.total.contacts = std::max(sums.total.contacts, report.contacts);
    for (std::size_t i = 0; i < kStageCount; ++i)
      sums.total.stage_seconds[i] += report.stage_seconds[i];
    sums.longest_step_seconds = std::max(sums.longest_step_seconds, seconds(report.stage_seconds));
    const Strain strain = cloth.strain();
    sums.max_strain = std::max(sums.max_strain, strain.max);
    strain_sum += strain.max;
    square_sum += strain.rms * strain.rms;
    sums.total.max_penetration = std::max(sums.total.max_penetration, cloth.max_penetration());
    lowest_y = cloth.position(0).y;
    for (std::uint32_t i = 0; i < cloth.particle_count(); ++i) {
      lowest_y = std::min(lowest_y, cloth.position(i).y);
    }
    sums.lowest = std::min(sums.lowest, lowest_y);
    sums.state_hash = cloth.state_hash();
    sums.energy_end = cloth.energy().total();
    sums.energy_gain = std::max(sums.energy_gain, sums.energy_end);
    sums.bytes = cloth.bytes() + describe(*cloth.model()).bytes;
    last = report;
  }
  static double seconds(const std::array<double, kStageCount>& stages) {
    return std::accumulate(stages.begin(), stages.end(), 0.0);
  }
};

/// Swings against the sphere and back, in steps too long for scheme rattle at times.
TEST_CASE("a summary sums up what the steps reported and what the cloth measured") {
  const SceneDescription scene = scenes::make("hang_sphere", {.size = 9}).value();
  constexpr int kSteps = 60;
  Frames frames;
  frames.sums.energy_gain = -1;
  const auto summary = run(
      scene,
      {.substeps = 4, .solver = Solver::gauss_seidel, .scheme = Scheme::rattle, .threads = 1},
      {.dt = 0.02, .steps = kSteps}, [&](int frame, const Cloth& cloth, const StepReport& report) {
        frames.add(cloth, report);
        CHECK(frame == frames.sums.frames);
      });
  REQUIRE(summary);
  const RunSummary &actual = summary.value(), &expected = frames.sums;
  CHECK(actual.frames == kSteps);
  CHECK(actual.total.status == Status::converged);
  CHECK(actual.total.substeps == expected.total.substeps);
  CHECK(actual.total.halvings == expected.total.halvings);
  CHECK(actual.total.iterations == expected.total.iterations);
  CHECK(actual.total.velocity_iterations == expected.total.velocity_iterations);
  CHECK(actual.total.direction_updates == expected.total.direction_updates);
  CHECK(actual.total.visits == expected.total.visits);
  CHECK(actual.total.corrections == expected.total.corrections);
  CHECK(actual.total.scheme_fallbacks == expected.total.scheme_fallbacks);
  CHECK(actual.total.contacts == expected.total.contacts);
  CHECK(actual.max_strain == expected.max_strain);
  CHECK(actual.mean_max_strain == frames.strain_sum / kSteps);
  CHECK(actual.rms_strain == std::sqrt(frames.square_sum / kSteps));
  CHECK(actual.total.max_penetration == expected.total.max_penetration);
  CHECK(actual.lowest == expected.lowest);
  CHECK(actual.state_hash == expected.state_hash);
  CHECK(actual.energy_end == expected.energy_end);
  CHECK(actual.energy_gain == expected.energy_gain - actual.energy_start);
  CHECK(actual.total.stage_seconds == expected.total.stage_seconds);
  CHECK(actual.step_seconds >= Frames::seconds(actual.total.stage_seconds));
  CHECK(actual.longest_step_seconds >= expected.longest_step_seconds);
  CHECK(actual.longest_step_seconds < actual.step_seconds);
  CHECK(actual.cpu_seconds > 0);
  CHECK(actual.cpu_seconds != actual.step_seconds);  // of another clock
  double other_stages = 0;
  for (std::size_t i = 0; i < kStageCount; ++i) {
    if (static_cast<Stage>(i) != Stage::report) other_stages += actual.total.stage_seconds[i];
  }
  CHECK(actual.solver_seconds == other_stages);
  CHECK(actual.bytes == expected.bytes);
  CHECK(actual.model.particles == 82);

  // The last frame is not the one with the most of anything.
  CHECK(frames.last.velocity_iterations < expected.total.velocity_iterations);
  CHECK(frames.last.scheme_fallbacks < expected.total.scheme_fallbacks);
  CHECK(frames.last.contacts < expected.total.contacts);
  CHECK(frames.last.max_strain < expected.max_strain);
  CHECK(frames.last.max_penetration < expected.total.max_penetration);
  CHECK(frames.lowest_y > expected.lowest);
}

TEST_CASE("sums of int stop at the largest") {
  StepReport total{.substeps = std::numeric_limits<int>::max() - 3};
  add_step(total, {.substeps = 2, .open_seams = 5});
  CHECK(total.substeps == std::numeric_limits<int>::max() - 1);
  add_step(total, {.substeps = 2, .open_seams = 4});
  CHECK(total.substeps == std::numeric_limits<int>::max());
  CHECK(total.open_seams == 4);
}

TEST_CASE("a summary tells of halves, contacts and memory") {
  const SceneDescription corners = scenes::make("corners", {.size = 21}).value();
  const SceneDescription sphere = scenes::make("hang_sphere", {.size = 9}).value();
  for (const SceneDescription* scene : {&corners, &sphere}) {
    Frames frames;
    const auto summary =
        run(*scene, {.substeps = 1, .solver = Solver::yarn}, {.dt = 0.05, .steps = 12},
            [&](int, const Cloth& cloth, const StepReport& report) { frames.add(cloth, report); });
    REQUIRE(summary);
    const RunSummary& expected = frames.sums;
    CHECK((scene == &corners ? expected.total.halvings : expected.total.contacts) > 0);
    CHECK(summary.value().total.halvings == expected.total.halvings);
    CHECK(summary.value().total.contacts == expected.total.contacts);
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
  CHECK(best.value().total.visits == once.value().total.visits);
}

TEST_CASE("of repeats the fastest is reported, not the last") {
  using Clock = std::chrono::steady_clock;
  constexpr int kSteps = 20;
  Clock::time_point start;
  std::chrono::duration<double> first_repeat{};
  std::optional<Slowness> slowness;
  int frame = 0;  // of all runs, the one to warm up included
  const auto watch = [&] {
    if (++frame == kSteps) start = Clock::now();
    if (frame != 2 * kSteps) return false;
    first_repeat = Clock::now() - start;
    slowness.emplace();
    return false;
  };
  const auto summary =
      run(hang(20), {.tolerance = 1e-4, .solver = Solver::gauss_seidel, .threads = 1},
          {.steps = kSteps, .repeat = 3, .stop = watch});
  slowness.reset();
  REQUIRE(summary);
  CHECK(summary.value().finished_runs == 4);
  CHECK(summary.value().step_seconds <= first_repeat.count());
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
  const auto limited =
      run(scene, {.tolerance = 1e-9, .max_iterations = 2, .solver = Solver::yarn}, {.steps = 5});
  REQUIRE(limited);
  CHECK(limited.value().total.status == Status::iteration_limit);
  CHECK_FALSE(limited.value().reached_tolerance());
  REQUIRE(limited.value().first_miss);
  CHECK(limited.value().first_miss->frame == 1);
  CHECK(limited.value().first_miss->status == Status::iteration_limit);
  CHECK(limited.value().first_miss->constraint < scene.constraints.size());
}

TEST_CASE("a frame that missed is not forgotten over those that did not") {
  SceneDescription shot;
  shot.positions = {{0, 0, 0}, {-0.5, 0, 0}};
  shot.velocities = {{0, 0, 0}, {100, 0, 0}};
  shot.masses = {1, 1};
  shot.fixed = {0};
  shot.spheres = {0};
  shot.radii = {0.1, 0};
  Status last = Status::passed_through;
  const auto summary =
      run(shot, {.substeps = 1}, {.steps = 3},
          [&](int, const Cloth&, const StepReport& report) { last = report.status; });
  REQUIRE(summary);
  CHECK(last == Status::converged);
  CHECK(summary.value().total.status == Status::passed_through);
  REQUIRE(summary.value().first_miss);
  CHECK(summary.value().first_miss->frame == 1);
  CHECK(summary.value().first_miss->passed_particle == 1);
}

TEST_CASE("a fixed number of iterations misses nothing") {
  const auto fixed = run(hang(8), {.iterations = 2}, {.steps = 5});
  REQUIRE(fixed);
  CHECK(fixed.value().total.status == Status::fixed_iterations);
  CHECK(fixed.value().total.iterations == 10);
  CHECK(fixed.value().reached_tolerance());
}

TEST_CASE("a run ends with the frame that would not be finite") {
  const auto summary = run(hang(4), {}, {.dt = 1e200, .steps = 5});
  REQUIRE(summary);
  CHECK(summary.value().total.status == Status::non_finite_input);
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
  const Miss inside{.frame = 1,
                    .status = Status::iteration_limit,
                    .max_penetration = 0.5,
                    .constraint = 7,
                    .inside = 4};
  CHECK(text(inside) ==
        "frame 1: iteration_limit; 4 particles of the cloth are inside a body; contacts are up to "
        "0.5 m deep");
  const Miss passed{
      .frame = 9, .status = Status::passed_through, .constraint = 7, .passed_particle = 4};
  CHECK(text(passed) == "frame 9: passed_through; particle 4 went through a sphere");
}

TEST_CASE("a sheet in a closed room that is turned outwards is said to be inside") {
  SceneDescription scene = hang(4);
  scene.fixed.clear();
  TriangleMesh room;
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    room.vertices.push_back(
        {corner & 1 ? 5.0 : -5.0, corner & 2 ? 5.0 : -5.0, corner & 4 ? 5.0 : -5.0});
  }
  room.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const auto summary = run(scene, {}, {.dt = 1.0 / 60, .steps = 2, .bodies = {{.shape = room}}});
  REQUIRE(summary);
  REQUIRE(summary.value().first_miss);
  CHECK(text(*summary.value().first_miss).find("inside a body") != std::string::npos);
}

/// A quarter of a turn about the pinned side's middle, half a metre up and on, in a second.
PinMove swing(const SceneDescription& scene) {
  return {.particles = scene.fixed,
          .times = {0, 0.25, 1},
          .translations = {{0, 0, 0}, {0, 0.25, 0}, {0.5, 0.5, 0}},
          .rotations = {{0, 0, 0}, {0, 0.5, 0}, {0, 1.5, 0}},
          .about = {0, 0, 0.5}};
}

TEST_CASE("in every frame pins are where their moves have them at its end, in every repeat") {
  const SceneDescription scene = hang(5);
  const RunPlan plan{.dt = 0.02, .steps = 60, .moves = {swing(scene)}};
  const auto summary = run(scene, {}, plan, [&](int frame, const Cloth& cloth, const StepReport&) {
    for (const std::uint32_t pin : scene.fixed) {
      const Vec3 at = cloth.position(pin);
      const Vec3 to = place_at(plan.moves[0], frame * plan.dt, scene.positions[pin]);
      CHECK(std::hypot(at.x - to.x, at.y - to.y, at.z - to.z) == 0);
    }
  });
  REQUIRE(summary);
  CHECK(summary.value().reached_tolerance());
  RunPlan repeated = plan;
  repeated.repeat = 2;
  const auto best = run(scene, {}, repeated);
  REQUIRE(best);
  CHECK(best.value().state_hash == summary.value().state_hash);
  CHECK(best.value().state_hash != run(scene, {}, {.dt = 0.02, .steps = 60}).value().state_hash);
}

TEST_CASE("the work of moved pins is summed up, and no gain of energy") {
  const SceneDescription scene = hang(9);
  for (const Solver solver : {Solver::yarn, Solver::direct, Solver::gauss_seidel}) {
    CAPTURE(name(solver));
    double work = 0, most = -1e9, most_beyond = -1e9;
    const auto summary = run(scene, {.solver = solver}, {.steps = 120, .moves = {swing(scene)}},
                             [&](int, const Cloth& cloth, const StepReport& report) {
                               work += report.pin_work;
                               const double energy = cloth.energy().total();
                               most = std::max(most, energy);
                               most_beyond = std::max(most_beyond, energy - work);
                             });
    REQUIRE(summary);
    const RunSummary& actual = summary.value();
    CHECK(actual.total.pin_work == work);
    CHECK(actual.energy_gain == doctest::Approx(most_beyond - actual.energy_start).epsilon(1e-9));
    CHECK(work > 1);
    CHECK(most - actual.energy_start > 0.1);
    CHECK(actual.energy_gain < 1e-3);
  }
}

TEST_CASE("where pins stay the work is none") {
  const auto summary = run(hang(5), {}, {.steps = 10});
  REQUIRE(summary);
  CHECK(summary.value().total.pin_work == 0);
}

TEST_CASE("what the library refuses is passed on") {
  const PinMove free{.particles = {24}, .times = {0}, .translations = {{1, 0, 0}}};
  CHECK_FALSE(run(hang(5), {}, {.moves = {free}}));

  CHECK_FALSE(run(SceneDescription{}, {}, {}));
  CHECK_FALSE(run(hang(3), {.tolerance = -1}, {}));
  CHECK_FALSE(run(hang(3), {}, {.dt = -1}));
}

}  // namespace
}  // namespace weft::tools
