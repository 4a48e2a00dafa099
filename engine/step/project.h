/// Work before a step begins, and the message of a step that is not committed.
#pragma once

#include "engine/step/state.h"

namespace weft {

/// Parts out of place where a step begins, because positions were given, pins were teleported, or
/// the model has changed.
struct OutOfPlace {
  bool edges = false;    // rigid ones are out of tolerance, or contacts and anchors
  bool springs = false;  // that are fast (fast_springs.h), or triangles of fabric
  bool any() const { return edges || springs; }
};
OutOfPlace find_out_of_place(State& s, Team& team);

/// Moves the positions onto the constraints and leaves the velocities. Springs that are out of
/// place come near the equilibrium among them: several times they relax from rest for a short
/// time, without gravity and forces. Errors beyond half of the iterations
/// that a step may take are left to the step, and to its status. Small steps have half of these
/// behind a solver, which ends at the other half.
void project(State& s, const OutOfPlace& what, double dt, StepReport& report, Team& team);

/// Explains a step that is not committed: which particle left the range of numbers, and whether
/// that would have happened without any constraint.
void explain(State& s, double dt_substep, StepReport& report, Team& team);

}  // namespace weft
