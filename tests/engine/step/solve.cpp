/// How a solver that fails is answered, within one attempt.
#include "engine/step/solve.h"

#include <doctest/doctest.h>

#include "engine/parallel/team.h"
#include "tests/support/clothes.h"

namespace weft::test {
namespace {

/// Ten bars of 0.1 in a straight line between fixed ends that are too near: at 0.95 nothing can be
/// done, at 0.9995 sweeps come within tolerance.
SceneDescription compressed_line(double length) {
  SceneDescription scene;
  for (int i = 0; i <= 10; ++i) {
    scene.positions.push_back({0.1 * length * i, 0, 0});
    scene.masses.push_back(1);
  }
  for (std::uint32_t i = 0; i < 10; ++i) scene.constraints.push_back({i, i + 1, 0.1});
  scene.fixed = {0, 10};
  return scene;
}

struct Answered {
  Trial trial;
  StepReport report;
  bool moved = false;
};

Answered answered(double length, OnFailure on_failure, int most_iterations = 1000) {
  Settings settings;
  settings.solver = Solver::direct;
  settings.tolerance = 1e-3;
  settings.substeps = 1;
  State s(model_of(compressed_line(length)), settings);
  s.solved = s.position;
  s.solved.view().add(5, {0.01, 0, 0});  // uneven, and straight
  const kernels::Vectors before = s.solved;
  Team team(1, s.team_state);
  Answered result;
  const Attempt attempt{.h = 0.01, .most_iterations = most_iterations, .on_failure = on_failure};
  result.trial = solve_positions(s, attempt, result.report, team);
  for (std::size_t i = 0; i < before.size(); ++i) {
    result.moved = result.moved || kernels::length(s.solved[i] - before[i]) > 0;
  }
  return result;
}

TEST_CASE("a direct solver that fails gives up at once, and has moved nothing") {
  for (const OnFailure on_failure : {OnFailure::halve, OnFailure::leave}) {
    const Answered a = answered(0.9995, on_failure);
    CHECK(a.trial.ended == Ended::gave_up);
    CHECK_FALSE(a.trial.has_result());
    CHECK(a.report.iterations <= 10);
    CHECK_FALSE(a.moved);
  }
}

TEST_CASE("or sweeps do it: within tolerance, but no solution of its own") {
  const Answered a = answered(0.9995, OnFailure::sweep);
  CHECK(a.trial.ended == Ended::made_do);
  CHECK(a.trial.status == Status::converged);
  CHECK(a.report.iterations > 10);
  CHECK(a.moved);
}

TEST_CASE("what cannot be solved costs no more iterations than there are") {
  for (const int most : {8, 20, 50, 300}) {
    CAPTURE(most);
    const Answered a = answered(0.95, OnFailure::sweep, most);
    CHECK(a.trial.ended == Ended::made_do);
    CHECK(a.trial.status == Status::iteration_limit);
    CHECK(a.report.iterations == most);
  }
}

}  // namespace
}  // namespace weft::test
