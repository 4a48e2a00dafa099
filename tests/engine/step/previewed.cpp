/// The original method as the paper has it, which keeps velocities and previews both ends of a
/// constraint at every visit, against the original of the engine, which keeps the previews: the
/// same steps, up to rounding.
#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "engine/isa.h"
#include "engine/step/previewed_sweeps.h"
#include "engine/step/state.h"
#include "engine/step/step.h"
#include "tests/support/clothes.h"
#include "tests/support/mesh_scenes.h"

namespace weft::test::engine_step_previewed {
namespace {

constexpr double kStep = 0.01;

Settings original() {
  Settings settings = on(Backend::reference);
  settings.isa = resolve(Isa::automatic).value();
  settings.solver = Solver::gauss_seidel;
  settings.measuring.anticipate = settings.measuring.skip = false;
  settings.measuring.directions = Directions::each;
  return settings;
}

double largest_distance(const kernels::Vectors& a, const kernels::Vectors& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, length(a[i] - b[i]));
  return largest;
}

/// Every step starts both from the same state. The last particles of the sheet are pulled sideways.
void check_steps(const SceneDescription& scene, const Settings& settings, int steps) {
  const auto model = model_of(scene);
  State kept(model, settings), previewed(model, settings);
  PreviewedSweeps solver(previewed);
  previewed.solver = &solver;
  kept.force.resize(model->slots());
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::size_t last = scene.positions.size() - 1 - i;
    kept.force.set(model->ordering.slot_of[last], {0.01, 0, 0.02});
  }
  for (int k = 0; k < steps; ++k) {
    CAPTURE(k);
    previewed.copy(kept);
    const StepReport expected = step(kept, kStep), found = step(previewed, kStep);
    REQUIRE(expected.status == Status::converged);
    REQUIRE(found.status == Status::converged);
    REQUIRE(found.iterations == expected.iterations);
    REQUIRE(found.velocity_iterations == expected.velocity_iterations);
    REQUIRE(found.direction_updates == expected.direction_updates);
    REQUIRE(found.visits == expected.visits);
    REQUIRE(found.corrections == expected.corrections);
    REQUIRE(largest_distance(previewed.position, kept.position) < 1e-13);
    REQUIRE(largest_distance(previewed.velocity, kept.velocity) < 1e-11);
    REQUIRE(std::abs(found.max_strain - expected.max_strain) < 1e-12);
  }
}

void check_scene(const SceneDescription& scene, int steps) {
  for (const Directions directions : {Directions::each, Directions::frozen}) {
    for (const bool velocity_correction : {false, true}) {
      CAPTURE(name(directions));
      CAPTURE(velocity_correction);
      Settings settings = original();
      settings.measuring.directions = directions;
      settings.velocity_correction = velocity_correction;
      check_steps(scene, settings, steps);
    }
  }
}

TEST_CASE("previewing at every visit changes no step of the paper's scenes beyond rounding") {
  for (const char* name : {"hang", "hang_sphere", "sphere_drop"}) {
    CAPTURE(std::string(name));
    check_scene(scene_of(name, 8), 100);
  }
}

TEST_CASE("nor of ropes, hubs and meshes with particles of unequal mass") {
  check_scene(roped_sheet(8), 30);
  check_scene(hub_sheet(8), 30);
  check_scene(random_sheet(8, 1), 30);
}

TEST_CASE("nor of a tight tolerance, a limited impulse, or a fixed number of iterations") {
  const SceneDescription scene = scene_of("hang", 8);
  Settings settings = original();
  settings.tolerance = 1e-5;
  check_steps(scene, settings, 50);
  settings.tolerance = 0.001;
  settings.measuring.impulse_limit = 0.002;
  check_steps(scene, settings, 20);
  settings = original();
  settings.iterations = 7;
  const auto model = model_of(scene);
  State kept(model, settings), previewed(model, settings);
  PreviewedSweeps solver(previewed);
  previewed.solver = &solver;
  for (int k = 0; k < 50; ++k) {
    step(kept, kStep);
    step(previewed, kStep);
  }
  CHECK(largest_distance(previewed.position, kept.position) < 1e-11);
}

TEST_CASE("nor of a start that has to be put right first") {
  SceneDescription scene = scene_of("hang", 8);
  for (Vec3& p : scene.positions) p.x *= 1.1;
  check_steps(scene, original(), 5);
}

}  // namespace
}  // namespace weft::test::engine_step_previewed
