#include "engine/step/previewed_sweeps.h"

#include "engine/solvers/sweeps/sweeps.h"
#include "engine/step/motion.h"

namespace weft {

PreviewedSweeps::PreviewedSweeps(State& s) : s_(s), reference_(*s.model, s.settings) {}

/// Until the commit next_velocity is not used.
kernels::LoopResult PreviewedSweeps::solve_positions(const PositionTask& task, Team&) {
  reference::Motion motion = reference_motion(s_);
  motion.velocity = s_.next_velocity.view();
  const kernels::LoopLimits limits{.fixed_iterations = s_.settings.iterations,
                                   .max_iterations = task.max_iterations,
                                   .renew_after = s_.settings.measuring.renew_after};
  return reference_.solve_previewed_positions(motion, task.dt_substep, task.contacts, task.laws,
                                              task.first_round, limits);
}

kernels::LoopResult PreviewedSweeps::correct_velocities(const VelocityTask& task, Team& team) {
  return s_.sweeps->correct_velocities(task, team);
}

}  // namespace weft
