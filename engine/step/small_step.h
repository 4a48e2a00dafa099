/// A step, or a substep that other solvers gave up, by small steps: small_step.cpp has the whole of
/// it from top to bottom.
#pragma once

#include "engine/step/attempt.h"
#include "engine/step/state.h"

namespace weft {

/// Computes the next state, in solved and next_velocity; its errors are in the report. Errors out
/// of tolerance in the end are put right in rounds or, if nothing is tried after it, said.
Trial small_step(State& s, const Attempt& attempt, double dt_frame, const Budget& budget,
                 StepReport& report, Team& team);

/// Puts solved, which is equal to position, right in the same rounds. Springs up to the compliance
/// `softest` have the time h from rest to give way; softer ones are left as they are. goes_on: from
/// where the last one of this step has ended.
void project_by_small_steps(State& s, double softest, double dt_frame, bool goes_on,
                            const Budget& budget, StepReport& report, Team& team);
/// solved: where a substep of h from rest leads, by its sweep alone. The memory stays.
void look_ahead_by_small_steps(State& s, double dt_frame, StepReport& report, Team& team);

}  // namespace weft
