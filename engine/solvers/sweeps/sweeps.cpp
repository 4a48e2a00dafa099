#include "engine/solvers/sweeps/sweeps.h"

#include <algorithm>

#include "engine/solvers/stall.h"
#include "engine/tuning.h"

namespace weft {

using kernels::LoopLimits;
using kernels::LoopResult;

Sweeps::Sweeps(const Model& model, const Settings& settings, const simd::Table& table,
               Measure& measure)
    : settings_(settings), measure_(measure) {
  if (settings.backend == Backend::reference)
    reference_.emplace(model, settings);
  else
    simd_.emplace(model, settings, table);
}

LoopResult Sweeps::sweep(const PositionTask& task, bool first, const LoopLimits& limits,
                         Team& team) {
  const kernels::VectorsView directions = task.along_start ? task.start : kernels::VectorsView{};
  return reference_ ? reference_->solve_positions(task.x, directions, task.dt_substep,
                                                  task.contacts, task.laws, first, limits)
                    : simd_->solve_positions(task.x, directions, task.contacts, task.laws, first,
                                             limits, team);
}

/// The last of the passes may have corrected the last error, and none was left to find that.
LoopResult Sweeps::solve_positions(const PositionTask& task, Team& team) {
  if (settings_.iterations > 0) {
    const LoopLimits limits{.fixed_iterations = settings_.iterations,
                            .renew_after = settings_.measuring.renew_after};
    return sweep(task, task.first_round, limits, team);
  }
  LoopResult sum;
  Stall stall(tuning::kRoundPatience);
  for (;;) {
    const int renew_after = stall.is_near() ? 1 : settings_.measuring.renew_after;
    const int part = std::min(task.max_iterations - sum.iterations, tuning::kPassesBetweenLooks);
    const bool first = task.first_round && sum.iterations == 0;
    count(sum, sweep(task, first, {.max_iterations = part, .renew_after = renew_after}, team));
    if (sum.converged) return sum;
    const double error = measure_.error(task.x, task.laws, task.contacts, team);
    sum.converged = error <= 1;
    sum.failed = !sum.converged && stall.has_stalled(error);
    if (sum.converged || sum.failed || sum.iterations >= task.max_iterations) return sum;
  }
}

LoopResult Sweeps::correct_velocities(const VelocityTask& task, Team& team) {
  const LoopLimits limits{.fixed_iterations = settings_.iterations,
                          .max_iterations = task.max_iterations,
                          .renew_after = settings_.measuring.renew_after};
  return reference_ ? reference_->correct_velocities(task.x, task.v, task.contacts, limits)
                    : simd_->correct_velocities(task.x, task.v, task.contacts, limits, team);
}

std::size_t Sweeps::bytes() const { return reference_ ? reference_->bytes() : simd_->bytes(); }

}  // namespace weft
