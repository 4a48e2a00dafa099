/// One time step: estimate, try, measure, accept or reject. step.cpp is the whole of it, from top
/// to bottom. Its parts are
///
///   plan           how many substeps, and the ordered list of attempts at each
///   air            forces that depend on velocities, found once per attempt
///   project        a start that violates the constraints
///   exact_substep  one substep by a prediction and a solver of constraints
///   small_step     a step, or a substep that solvers gave up, by small steps
///   energy         which attempts are rejected for the energy they gain, and the guard
///   pins, anchors  fixed particles and points of anchors that are moved
///   pin_work       the work that they do
///   rest           whether a cloth rests, and sleeps
///   tearing        breaks at the end of the step
#pragma once

#include <weft/weft.h>

#include "engine/step/state.h"

namespace weft {

/// Advances the state by dt > 0, or leaves it as it was: where committed(status) is false, and
/// where it throws.
StepReport step(State& state, double dt, Team& team);
/// The same by this thread alone.
inline StepReport step(State& state, double dt) {
  Team alone;
  return step(state, dt, alone);
}

}  // namespace weft
