/// What a step may have to do before it begins, and to say in the end.
#pragma once

#include "engine/step/state.h"

namespace weft {

/// Whether a constraint or contact is out of tolerance; with a fixed number of iterations nobody
/// asks.
bool violates_constraints(State& s, Team& team);

/// Moves the positions onto the constraints and leaves the velocities: the error of a start would
/// become a velocity of error / h. What cannot be put right with half of the iterations that a
/// substep may take is left to the step, and to its status. Returns what sweeps could not solve.
double project(State& s, double h, double allowance, StepReport& report, Team& team);

/// Of a step that is not committed: who left the range of numbers, and whether that would have
/// happened without any constraint.
void explain(State& s, double h, StepReport& report, Team& team);

}  // namespace weft
