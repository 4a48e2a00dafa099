/// The list of attempts that a substep may need, and how a step walks it.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/isa.h"
#include "engine/parallel/team.h"
#include "engine/solvers/yarn/yarn_solver.h"
#include "engine/step/plan.h"
#include "engine/step/state.h"
#include "engine/step/step.h"
#include "tests/support/clothes.h"

namespace weft::test::engine_step_attempts {
namespace {

constexpr std::array kMethodNames{"solver", "stand_in", "small_steps", "sweeps"};

std::string text(const Attempt& attempt) {
  std::string text = kMethodNames[static_cast<std::size_t>(attempt.method)];
  if (attempt.scheme == Scheme::rattle) text = "rattle";
  if (attempt.parts > 1) text += " / " + std::to_string(attempt.parts);
  if (attempt.doublings > 0) text += " x " + std::to_string(1 << attempt.doublings);
  return attempt.is_last ? text + '.' : text + ", ";
}

std::string list_of(State& s) {
  Team team;
  StepReport report;
  const Plan plan = plan_for(s, 0.01, report, team);
  std::string list;
  for (const Attempt& attempt : plan.list()) list += text(attempt);
  return list;
}

State state_of(const SceneDescription& scene, Settings settings) {
  settings.isa = resolve(Isa::automatic).value();
  return State(model_of(scene), settings);
}

std::string list_of(const SceneDescription& scene, const Settings& settings,
                    double refinement = 0) {
  State s = state_of(scene, settings);
  s.refinement = refinement;
  return list_of(s);
}

TEST_CASE("the list of attempts") {
  const SceneDescription scene = scene_of("hang", 5);
  const auto list = [&](const Settings& settings, double refinement = 0) {
    return list_of(scene, settings, refinement);
  };
  const std::string rest = "small_steps, sweeps.";
  const std::string halves = "solver / 2, solver / 4, solver / 8, solver / 16, ";
  CHECK(list({.solver = Solver::yarn}) == "solver, " + halves + rest);
  CHECK(list({.solver = Solver::direct}) == "solver, " + halves + rest);
  CHECK(list({.solver = Solver::yarn, .scheme = Scheme::rattle}) ==
        "rattle, solver, " + halves + rest);
  CHECK(list({.solver = Solver::small_steps}) == "small_steps.");
  CHECK(list({.solver = Solver::gauss_seidel}) == "solver.");
  CHECK(list({.solver = Solver::gauss_seidel, .scheme = Scheme::rattle}) == "rattle, solver.");
  SUBCASE("begins where the last steps had to go") {
    CHECK(list({.solver = Solver::yarn}, 2) == "solver / 4, solver / 8, solver / 16, " + rest);
    CHECK(list({.solver = Solver::yarn}, 0.4) == "solver, " + halves + rest);
    CHECK(list({.solver = Solver::yarn}, 4) == "solver / 16, " + rest);
    CHECK(list({.solver = Solver::gauss_seidel}, 2) == "solver.");
  }
  SUBCASE("has one entry where the number of iterations is fixed") {
    CHECK(list({.iterations = 3, .solver = Solver::yarn}) == "solver.");
    CHECK(list({.iterations = 3, .solver = Solver::direct, .scheme = Scheme::rattle}) == "rattle.");
    CHECK(list({.iterations = 3, .solver = Solver::small_steps}) == "small_steps.");
  }
  SUBCASE("has more and more substeps where those of fabric are automatic") {
    const SceneDescription fabric = scene_of("drape", 5);
    const Settings small_steps{.solver = Solver::small_steps};
    const auto list_of_next = [&](const Settings& settings, bool displaced = false) {
      State s = state_of(fabric, settings);
      s.placed = false;
      s.displaced = displaced;
      return list_of(s);
    };
    CHECK(list_of_next(small_steps) ==
          "small_steps, small_steps x 2, small_steps x 4, small_steps x 8, small_steps x 16.");
    CHECK(list_of_next({.motion_tolerance = 0.1, .solver = Solver::small_steps}) ==
          list_of_next(small_steps));
    CHECK(list_of_next({.substeps = 10, .solver = Solver::small_steps}) == "small_steps.");
    CHECK(list_of_next({.iterations = 1, .solver = Solver::small_steps}) == "small_steps.");
    CHECK(list_of_next(small_steps, true) == "small_steps.");
    CHECK(list_of(fabric, small_steps) == list_of_next(small_steps));
  }
  SUBCASE("has the direct solver where masses are unequal") {
    SceneDescription chain = scene_of("chain", 20);
    chain.masses.back() = 1e5;
    CHECK(list_of(chain, {.solver = Solver::yarn}) == "solver, " + halves + "stand_in, " + rest);
    CHECK(list_of(chain, {.solver = Solver::direct}) == "solver, " + halves + rest);
  }
}

/// What a solver was asked for, and where the cloth was.
struct Call {
  double h = 0;
  kernels::Vectors position, velocity;
};

/// Yarns, but for what `gives_up` says of the calls, counted from 0: there it leaves a mess.
class Scripted final : public ConstraintSolver {
 public:
  Scripted(State& s, std::function<bool(std::size_t)> gives_up)
      : s_(s), gives_up_(std::move(gives_up)) {
    s.solver = this;
  }

  kernels::LoopResult solve_positions(const PositionTask& task, Team& team) override {
    calls.push_back({task.dt_substep, s_.position, s_.velocity});
    if (!gives_up_(calls.size() - 1)) return s_.yarn->solve_positions(task, team);
    for (std::size_t i = 0; i < s_.model->slots(); ++i) task.x.set(i, {1e3, 1e3, 1e3});
    return {.iterations = iterations_of_a_failure, .failed = true};
  }
  kernels::LoopResult correct_velocities(const VelocityTask& task, Team& team) override {
    return s_.yarn->correct_velocities(task, team);
  }
  std::size_t bytes() const override { return 0; }

  int iterations_of_a_failure = 1;
  std::vector<Call> calls;

 private:
  State& s_;
  std::function<bool(std::size_t)> gives_up_;
};

constexpr double kDt = 1.0 / 64;  // whose parts are exact

State hanging(Settings settings = {.substeps = 1, .solver = Solver::yarn}) {
  return state_of(scene_of("hang", 5), settings);
}

/// In sixteenths of the step.
std::vector<double> lengths(const Scripted& solver) {
  std::vector<double> lengths;
  for (const Call& call : solver.calls) lengths.push_back(16 * call.h / kDt);
  return lengths;
}

bool same(const kernels::Vectors& a, const kernels::Vectors& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

TEST_CASE("only the part that is rejected is done in halves, and what was done before it is kept") {
  State s = hanging();
  Scripted solver(s, [](std::size_t call) { return call == 0 || call == 2 || call == 4; });
  const StepReport report = step(s, kDt);
  CHECK(lengths(solver) == std::vector<double>{16, 8, 8, 4, 4, 2, 2});
  CHECK(report.halvings == 3);
  CHECK(report.substeps == 4);  // 8, 4, 2, 2
  CHECK(report.status == Status::converged);
  CHECK(s.refinement == 2);
}

TEST_CASE("behind a part that was done in halves parts are as long as they would have been") {
  State s = hanging();
  Scripted solver(s, [](std::size_t call) { return call <= 3; });
  step(s, kDt);
  CHECK(lengths(solver) == std::vector<double>{16, 8, 4, 2, 1, 1, 2, 4, 8});
}

TEST_CASE("an attempt that is rejected leaves the state as it was") {
  State s = hanging();
  Scripted solver(s, [](std::size_t call) { return call == 0 || call == 2; });
  const kernels::Vectors before = s.position;
  step(s, kDt);
  REQUIRE(solver.calls.size() == 5);
  CHECK(same(solver.calls[0].position, before));
  CHECK(same(solver.calls[1].position, before));
  CHECK_FALSE(same(solver.calls[2].position, before));
  CHECK(same(solver.calls[3].position, solver.calls[2].position));
  CHECK(same(solver.calls[3].velocity, solver.calls[2].velocity));
}

TEST_CASE("what was done in parts is what steps of their lengths come to") {
  State s = hanging(), in_steps = hanging();
  Scripted solver(s, [](std::size_t call) { return call == 0; });
  step(s, kDt);
  for (int k = 0; k < 2; ++k) step(in_steps, kDt / 2);
  CHECK(same(s.position, in_steps.position));
}

TEST_CASE("the next step begins with about as many parts as were needed, and later with one") {
  State s = hanging();
  Scripted solver(s, [](std::size_t call) { return call < 2; });
  step(s, kDt);
  CHECK(s.refinement == doctest::Approx(std::log2(3)));  // 4, 4, 8
  solver.calls.clear();
  const auto parts_of_next_step = [&] {
    solver.calls.resize(2);  // a call that does not give up
    step(s, kDt);
    return solver.calls.size() - 2;
  };
  CHECK(parts_of_next_step() == 4);
  for (int k = 0; k < 8; ++k) step(s, kDt);
  CHECK(parts_of_next_step() == 1);
}

TEST_CASE("small steps do what is left of a substep that solvers give up") {
  State s = hanging();
  Scripted solver(s, [](std::size_t call) { return call == 0 || call > 1; });
  const double height = s.model->initial_position.y[s.model->ordering.slot_of[24]];
  const StepReport report = step(s, kDt);
  CHECK(lengths(solver) == std::vector<double>{16, 8, 8, 4, 2, 1});
  CHECK(report.halvings == 5);
  CHECK(report.status == Status::converged);
  // As far as it falls, but for what scheme paper adds in its first part.
  CHECK(height - s.position.y[s.model->ordering.slot_of[24]] ==
        doctest::Approx(10 * kDt * kDt / 2).epsilon(0.5));
}

TEST_CASE("a solver that has used up half of the iterations leaves the rest to the last attempt") {
  State s = hanging({.substeps = 1, .max_iterations = 100'000, .solver = Solver::yarn});
  Scripted solver(s, [](std::size_t) { return true; });
  solver.iterations_of_a_failure = 50'000;
  const StepReport report = step(s, kDt);
  CHECK(lengths(solver) == std::vector<double>{16});
  CHECK(report.halvings == 1);
  CHECK(report.substeps == 1);
  CHECK(report.status == Status::converged);
}

/// Three particles on a line whose ends are fixed half as far again apart as the bars are long.
SceneDescription pulled_too_far() {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1.4, 0, 0}, {3, 0, 0}};
  scene.masses = {1, 1, 1};
  scene.fixed = {0, 2};
  scene.constraints = {{0, 1, 1}, {1, 2, 1}};
  return scene;
}

TEST_CASE("nothing is tried after the last attempt: its result counts, with its error") {
  State s = state_of(pulled_too_far(), {.substeps = 1, .solver = Solver::yarn});
  s.placed = false;
  const StepReport report = step(s, kDt);
  CHECK(committed(report.status));
  CHECK(report.status == Status::infeasible);
  CHECK(report.max_strain > 0.4);
  CHECK(report.halvings == 5);  // parts of five lengths, and small steps
  const double x = s.position.x[s.model->ordering.slot_of[1]];
  CHECK(x != 1.4);
  CHECK(report.max_strain == doctest::Approx(std::max(std::abs(x - 1), std::abs(2 - x))));
}

}  // namespace
}  // namespace weft::test::engine_step_attempts
