/// Constraints that cannot all be met.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "tools/studies/hard/scenes.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

constexpr double kTooFar = 1.1;  // of the chain's length

/// Says that it is infeasible in every step, and comes to rest: the figure is how fast the fastest
/// particle moves from place to place in the end.
Outcome run_pulled(const Setup& setup) {
  Trial trial{pulled_chain(kTooFar), setup.settings(0.001)};
  trial.steps = setup.steps(120, 20);
  const auto last = std::make_shared<Snapshot>();
  const auto speed = std::make_shared<double>(0);
  trial.after_step = [last, speed, &trial](const Cloth& cloth, int) {
    const Snapshot now = snapshot(cloth);
    *speed = 0;
    for (std::size_t i = 0; i < last->positions.size(); ++i) {
      *speed = std::max(*speed, length(now.positions[i] - last->positions[i]) / trial.dt);
    }
    *last = now;
  };
  const Observed o = observe(trial);
  Outcome result = outcome(*speed, o, kAnyEnergy);
  if (o.missed != o.steps || o.worst != Status::infeasible) {
    result.failure = fmt::format("{} of {} steps did not converge, the worst {}", o.missed, o.steps,
                                 name(o.worst));
  }
  if (o.max_strain > 0.5) result.failure = "the error is not shared out";
  return result;
}

/// The ends come back within a second, without gravity: nothing should move faster than the ends'
/// 2 cm/s.
Outcome run_return(const Setup& setup) {
  Trial trial{pulled_chain(kTooFar), setup.settings(0.001)};
  trial.scene.gravity = {0, 0, 0};
  trial.steps = setup.steps(200, 110);
  const int there = setup.steps(30, 5), back = 100;
  const auto end = static_cast<std::uint32_t>(trial.scene.positions.size() - 1);
  const double taut = trial.scene.positions[end].x / kTooFar;
  trial.before_step = [=](Cloth& cloth, int step) {
    const double way = std::clamp((step - there) / static_cast<double>(back), 0.0, 1.0);
    const double stretch = kTooFar + (1 - kTooFar) * way;
    (void)cloth.move_fixed(end, {stretch * taut, 0, 0});
  };
  const Observed o = observe(trial);
  Outcome result = outcome(o.most_kinetic, o, kAnyEnergy);
  if (o.end_strain > trial.settings.tolerance) result.failure = "does not recover";
  return result;
}

/// Triangles that share every edge cannot shear: the sheet is a plate, and has to fold or say so.
Outcome run_diagonals(const Setup& setup, std::string_view name) {
  const int size = 11;
  Trial trial{sheet(name, size), setup.settings(0.001)};
  add_diagonals(trial.scene, size);
  trial.settings.max_iterations = 100'000;
  trial.steps = setup.steps(200, 30);
  // What the direct solver gains where constraints are redundant is not bounded yet.
  return honesty_outcome(trial, not_by_relaxation(setup.method) ? kAnyEnergy : 1e-3);
}

}  // namespace

std::vector<Case> infeasible_cases() {
  std::vector<Case> cases;
  cases.push_back({"chain_pulled", "m/s, where it should be at rest", 1e-6, run_pulled});
  // What no sweep can solve the next one finds again, and takes for a motion.
  cases.back().claimed = [](const Method& method) { return method.solver != Solver::small_steps; };
  cases.push_back({"chain_returns", "J, largest kinetic energy", 0.1, run_return});
  for (const std::string name : {"corners", "hang_sphere", "sphere_drop"}) {
    cases.push_back({"diagonals_" + name, "false reports", 0,
                     [name](const Setup& setup) { return run_diagonals(setup, name); }});
  }
  return cases;
}

}  // namespace weft::tools::hard
