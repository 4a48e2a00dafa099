/// A long run: nothing grows, nothing drifts, nothing slows down.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "tools/studies/hard/scenes.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

constexpr double kDt = 0.01;

Trial long_run(const Setup& setup) {
  Trial trial{sheet("hang", 20), setup.settings(kStrain)};
  trial.dt = kDt;
  trial.steps = setup.steps(30'000, 3'000);
  return trial;
}

Outcome run_strain(const Setup& setup) {
  return strain_outcome(long_run(setup), energy_of_the_catch(20, kStrain, kDt));
}

/// Schemes of first order damp motion, those of second order let the sheet swing on. (automatic is
/// bdf2 here.)
bool comes_to_rest(const Method& method) {
  return method.scheme == Scheme::paper || method.scheme == Scheme::implicit;
}

/// At rest: nothing has moved since the middle of the run, apart from what the tolerance leaves.
/// Scheme implicit damps by the length of a substep, which is half of a frame here: it takes twice
/// as long.
Outcome run_drift(const Setup& setup) {
  Trial trial = long_run(setup);
  trial.steps = std::max(trial.steps, setup.method.scheme == Scheme::implicit ? 20'000 : 10'000);
  const auto middle = std::make_shared<Snapshot>(Snapshot{trial.scene.positions, {}});
  trial.after_step = [middle, half = trial.steps / 2](const Cloth& cloth, int step) {
    if (step == half) *middle = snapshot(cloth);
  };
  const Observed o = observe(trial);
  double moved = 0;
  for (std::size_t i = 0; i < o.end.positions.size(); ++i) {
    moved = std::max(moved, length(o.end.positions[i] - middle->positions[i]));
  }
  return outcome(moved, o, energy_of_the_catch(20, kStrain, kDt));
}

/// A sheet under gravity so weak that speeds die away through all denormal numbers: its last steps
/// must not take longer than its first. Medians, since others use the machine.
Outcome run_denormals(const Setup& setup) {
  Trial trial{sheet("hang", 20), setup.settings(kStrain)};
  trial.scene.gravity = {0, 0, 0};
  for (Vec3& position : trial.scene.positions) position.x *= 0.995;
  trial.scene.velocities.assign(trial.scene.positions.size(), {1e-290, 1e-300, 1e-310});
  trial.settings.iterations = 20;  // the same work in every step
  trial.steps = setup.steps(1'500, 300);
  Trial normal = trial;
  normal.scene.velocities.assign(normal.scene.positions.size(), {1e-3, 1e-3, 1e-3});
  const Observed small = observe(trial), usual = observe(normal);
  return outcome(small.seconds / usual.seconds, small, kAnyEnergy);
}

}  // namespace

std::vector<Case> length_cases() {
  return {
      {"long_run", "max strain", kStrain, run_strain},
      {"long_run_drift", "m, moved in its second half", 0.05, run_drift, comes_to_rest},
      {"denormals", "time per step, to that of usual numbers", 2, run_denormals},
  };
}

}  // namespace weft::tools::hard
