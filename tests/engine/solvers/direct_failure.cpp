/// The direct solver alone, where Newton's method leads nowhere.
#include <doctest/doctest.h>

#include "engine/solvers/direct_solver.h"
#include "tests/support/clothes.h"

namespace weft::test {
namespace {

/// Ten bars of 0.1 in a straight line between fixed ends that are nearer than 1.
SceneDescription compressed_line() {
  SceneDescription scene;
  for (int i = 0; i <= 10; ++i) {
    scene.positions.push_back({0.095 * i, 0, 0});
    scene.masses.push_back(1);
  }
  for (std::uint32_t i = 0; i < 10; ++i) scene.constraints.push_back({i, i + 1, 0.1});
  scene.fixed = {0, 10};
  return scene;
}

struct Trial {
  std::shared_ptr<const Model> model;
  kernels::Vectors x;
  ContactStore contacts;
  DirectSolver solver;

  explicit Trial(const SceneDescription& scene)
      : model(model_of(scene)),
        x(model->initial_position),
        contacts(make_contact_store(*model)),
        solver(*model, Settings{}, simd::table(simd::best_isa())) {}
  kernels::LoopResult solve(DirectSolver::From from, bool noise_will_do) {
    return solver.solve_positions(x.view(), contacts, from, 1000, noise_will_do);
  }
};

TEST_CASE("failure is told after a few solves, and leaves positions where they were") {
  for (const bool noise_will_do : {false, true}) {
    Trial trial(compressed_line());
    const auto result = trial.solve(DirectSolver::From::prediction, noise_will_do);
    CHECK(result.failed);
    CHECK_FALSE(result.converged);
    CHECK(result.iterations <= 10);
    for (std::size_t p = 0; p < trial.x.size(); ++p) {
      CHECK(kernels::length(trial.x[p] - trial.model->initial_position[p]) == 0);
    }
  }
}

TEST_CASE("what converges has not failed") {
  Trial trial(scene_of("hang", 9));
  for (std::size_t p = 0; p < trial.x.size(); ++p) {
    if (trial.model->inverse_mass[p] > 0) trial.x.view().add(p, {0, -5e-4, 0});
  }
  const auto result = trial.solve(DirectSolver::From::prediction, false);
  CHECK(result.converged);
  CHECK_FALSE(result.failed);
}

}  // namespace
}  // namespace weft::test
