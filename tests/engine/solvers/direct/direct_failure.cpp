/// The direct solver, where Newton's method leads nowhere.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>

#include "engine/solvers/direct/direct_solver.h"
#include "tests/support/clothes.h"
#include "tests/support/mesh_scenes.h"

namespace weft::test::engine_solvers_direct_direct_failure {
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
  SphereContacts contacts;
  DirectSolver solver;

  explicit Trial(const SceneDescription& scene)
      : model(model_of(scene)),
        x(model->initial_position),
        contacts(make_sphere_contacts(*model)),
        solver(*model, Settings{}, simd::table(simd::best_isa())) {}
  kernels::LoopResult solve() {
    Team team;
    return solver.solve_positions(
        {.x = x.view(), .start = {}, .contacts = contacts, .max_iterations = 1000}, team);
  }
};

TEST_CASE("failure is told after a few solves, and leaves positions where they were") {
  Trial trial(compressed_line());
  const auto result = trial.solve();
  CHECK(result.failed);
  CHECK_FALSE(result.converged);
  CHECK(result.iterations <= 10);
  for (std::size_t p = 0; p < trial.x.size(); ++p) {
    CHECK(kernels::length(trial.x[p] - trial.model->initial_position[p]) == 0);
  }
}

TEST_CASE("what converges has not failed") {
  Trial trial(scene_of("hang", 9));
  for (std::size_t p = 0; p < trial.x.size(); ++p) {
    if (trial.model->inverse_mass[p] > 0) trial.x.view().add(p, {0, -5e-4, 0});
  }
  const auto result = trial.solve();
  CHECK(result.converged);
  CHECK_FALSE(result.failed);
}

/// Ropes between particles of very different masses, thrown about.
SceneDescription thrown_ropes() {
  SceneDescription scene;
  scene.positions = {{0.14363, -0.068572, 0.10788},  {0.15686, -0.25766, -0.15786},
                     {0.39766, -0.18588, -0.077788}, {0.25435, -0.17269, -0.082734},
                     {0.28046, -0.1596, -0.12535},   {0.16165, -0.098357, -0.05254}};
  scene.velocities = {{-1.1588, -0.29245, 0.043062}, {-0.186, 1.4776, -0.64109},
                      {-0.32734, 0.4111, -0.2845},   {-0.29699, 0.98155, 0.093343},
                      {-1.6831, 0.25576, -0.18752},  {-1.506, 1.294, -0.33867}};
  scene.masses = {0.19216, 0.12779, 0.28972, 0.002616, 0.025363, 0.00050014};
  scene.constraints = {{1, 3, 0.14955}, {2, 4, 0.15437}, {3, 5, 0.12779},
                       {3, 2, 0.144},   {5, 0, 0.16416}, {5, 4, 0.15269}};
  for (Constraint& c : scene.constraints) c.kind = ConstraintKind::rope;
  scene.gravity = {0, 0, 0};
  return scene;
}

TEST_CASE("what leads beyond all numbers has failed, and others can go on") {
  Cloth cloth =
      cloth_of(thrown_ropes(), {.tolerance = 0.1, .substeps = 3, .solver = Solver::direct});
  const double before = cloth.energy().total();
  const StepReport report = step(cloth, 1. / 60);
  CHECK(report.status == Status::converged);
  CHECK(report.max_strain <= 0.1);
  CHECK(cloth.energy().total() < before);
}

// Where Newton's method was when its iterations ran out: 1e8 times the energy, strains of 1e14.
TEST_CASE("between masses far apart too few iterations bring neither energy nor large strains") {
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    SceneDescription scene = scene_of(grid(6, 6));
    scene.gravity = {0, 0, 0};
    scene.fixed = {0};
    for (double& mass : scene.masses) mass = std::pow(10, random.between(-4.5, 0.5));
    for (std::size_t i = 0; i < scene.masses.size(); ++i) {
      scene.velocities.push_back(random.in_box(2));
    }
    Cloth cloth =
        cloth_of(scene, {.tolerance = 1e-3, .max_iterations = 20, .solver = Solver::direct});
    for (int k = 0; k < 12; ++k) {
      const double before = cloth.energy().kinetic;
      CHECK(step(cloth, 1. / 60).max_strain < 2);
      CHECK(cloth.energy().kinetic < 1.1 * before);
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_solvers_direct_direct_failure
