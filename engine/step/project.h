/// What a step may have to do before it begins, and to say where it is not committed.
#pragma once

#include "engine/step/state.h"

namespace weft {

/// Whether the start is out of tolerance because positions were given, or pins have jumped; or
/// because it comes from a step that was far longer than dt: what that left within tolerance, an
/// error e, would come back as speed, e / dt. The paper's loop leaves errors of up to the tolerance
/// in every step, and small steps release them slowly: for these a far shorter step is none.
bool needs_projection(State& s, double dt, bool jumped, Team& team);

/// Moves the positions onto the constraints and leaves the velocities. What cannot be put right
/// with half of the iterations that a step may take is left to the step, and to its status. Small
/// steps have half of these behind a solver, which ends at the other half.
void project(State& s, double dt, StepReport& report, Team& team);

/// Of a step that is not committed: who left the range of numbers, and whether that would have
/// happened without any constraint.
void explain(State& s, double h, StepReport& report, Team& team);

/// The true errors at x, where a step ends or where it begins.
void report_errors(State& s, kernels::Vectors& x, bool ends, StepReport& report, Team& team);

}  // namespace weft
