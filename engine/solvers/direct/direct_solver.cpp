#include "engine/solvers/direct/direct_solver.h"

#include <algorithm>
#include <cmath>

#include "engine/solvers/direct/direct_impulses.h"
#include "engine/solvers/direct/direct_layout.h"
#include "engine/solvers/direct/direct_measure.h"
#include "engine/solvers/stall.h"
#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::LoopResult;
using kernels::VectorsView;

void copy(VectorsView from, VectorsView to, std::size_t n) {
  std::copy_n(from.x, n, to.x);
  std::copy_n(from.y, n, to.y);
  std::copy_n(from.z, n, to.z);
}

}  // namespace

DirectSolver::DirectSolver(const Model& model, const Settings& settings, const simd::Table& kernels)
    : settings_(settings),
      system_(model, settings),
      factor_(model.direct(), kernels),
      bodies_(model.direct()),
      balance_(model),
      stiff_(model),
      start_(model.slots()) {}

LoopResult DirectSolver::solve_positions(const PositionTask& task, Team&) {
  if (task.along_start) return solve_from_start(task);
  const LoopResult result = solve_from_prediction(task);
  if (task.laws != nullptr)
    std::copy_n(system_.total.data(), task.laws->multiplier.size(), task.laws->multiplier.data());
  return result;
}

LoopResult DirectSolver::solve_from_prediction(const PositionTask& task) {
  LoopResult result;
  system_.start(task.contacts, task.first_round, task.laws);
  if (settings_.iterations > 0) {
    iterate_fixed(task.x, {}, task.contacts, result);
    return result;
  }
  if (task.first_round) balance_.start(task.x);
  copy(task.x, start_.view(), start_.size());
  const DirectOutcome outcome = iterate(task.x, {}, task.contacts, task.max_iterations, result);
  bool solved = outcome == DirectOutcome::converged && balance_.is_explained(system_, task.x);
  if (!solved && stiff_.wanted()) {
    solved = iterate_stiff(task.x, task.contacts, task.max_iterations, result) ==
             DirectOutcome::converged;
  }
  result.converged = solved;
  result.failed = !solved;
  if (!solved) copy(start_.view(), task.x, start_.size());
  return result;
}

LoopResult DirectSolver::solve_from_start(const PositionTask& task) {
  LoopResult result;
  system_.start(task.contacts, task.first_round);
  const DirectOutcome outcome =
      settings_.iterations > 0
          ? iterate_fixed(task.x, task.start, task.contacts, result)
          : iterate(task.x, task.start, task.contacts, task.max_iterations, result);
  result.converged = outcome == DirectOutcome::converged;
  result.failed = !result.converged;
  return result;
}

/// Newton's method from x; with directions at `start`, the simplified Newton method.
DirectOutcome DirectSolver::iterate(VectorsView x, VectorsView start,
                                    const SphereContacts& contacts, int max_iterations,
                                    LoopResult& result) {
  Stall stall(tuning::kDirectPatience);
  const double goal = std::min(1.0, tuning::kDirectGoal / settings_.tolerance);
  bool solved = false;
  for (;;) {
    const double worst = measure_positions(system_, x, start, contacts);
    result.visits += system_.count();
    if (worst <= tuning::kNegligibleError || (solved && worst <= goal))
      return DirectOutcome::converged;
    const bool within = worst <= 1;
    if (!std::isfinite(worst) || stall.has_stalled(worst)) {
      return within && start.x != nullptr ? DirectOutcome::converged : DirectOutcome::failed;
    }
    if (result.iterations >= max_iterations) {
      return within ? DirectOutcome::converged : DirectOutcome::exhausted;
    }
    solved = true;
    ++result.direction_updates;
    if (!solve(x, result)) return DirectOutcome::failed;
  }
}

DirectOutcome DirectSolver::iterate_stiff(VectorsView x, const SphereContacts& contacts,
                                          int max_iterations, LoopResult& result) {
  copy(start_.view(), x, start_.size());
  system_.start(contacts, true, system_.laws);
  balance_.start(x);
  return stiff_.iterate(system_, factor_, balance_, x, contacts, max_iterations, result);
}

DirectOutcome DirectSolver::iterate_fixed(VectorsView x, VectorsView start,
                                          const SphereContacts& contacts, LoopResult& result) {
  while (result.iterations < settings_.iterations) {
    measure_positions(system_, x, start, contacts);
    result.visits += system_.count();
    ++result.direction_updates;
    if (!solve(x, result)) return DirectOutcome::failed;
  }
  return DirectOutcome::exhausted;
}

LoopResult DirectSolver::correct_velocities(const VelocityTask& task, Team&) {
  const VectorsView v = task.v;
  LoopResult result;
  system_.start(task.contacts, true);
  copy(v, start_.view(), start_.size());
  const DirectOutcome outcome =
      iterate_velocities(task.x, v, task.contacts, task.exact, task.max_iterations, result);
  result.converged = outcome == DirectOutcome::converged;
  if (result.converged || settings_.iterations > 0) return result;
  copy(start_.view(), v, start_.size());
  result.failed = outcome == DirectOutcome::failed && result.iterations < task.max_iterations;
  return result;
}

/// The constraints are linear in the velocities, so that more than one solve is needed only where
/// the active set changes.
DirectOutcome DirectSolver::iterate_velocities(VectorsView x, VectorsView v,
                                               const SphereContacts& contacts, bool exact,
                                               int max_iterations, LoopResult& result) {
  const bool fixed = settings_.iterations > 0;
  Stall stall(tuning::kDirectPatience);
  for (;;) {
    const double worst = measure_velocities(system_, x, v, contacts);
    result.visits += system_.count();
    const bool wanted = exact && result.iterations == 0 && worst > tuning::kNegligibleError;
    if (!fixed && worst <= 1 && !wanted) return DirectOutcome::converged;
    if (fixed && result.iterations == settings_.iterations) return DirectOutcome::exhausted;
    if (!fixed && (!std::isfinite(worst) || stall.has_stalled(worst))) return DirectOutcome::failed;
    if (!fixed && result.iterations >= max_iterations) return DirectOutcome::exhausted;
    if (!solve(v, result)) return DirectOutcome::failed;
  }
}

/// One solve with the measured errors. It changes u, which are positions or velocities.
bool DirectSolver::solve(VectorsView u, LoopResult& result) {
  if (!solve_impulses(system_, factor_, bodies_)) return false;
  ++result.iterations;
  apply_impulses(system_, u);
  result.corrections += system_.active;
  return true;
}

std::size_t DirectSolver::bytes() const {
  return system_.bytes() + factor_.bytes() + bodies_.bytes() + balance_.bytes() + stiff_.bytes() +
         start_.bytes();
}

}  // namespace weft
