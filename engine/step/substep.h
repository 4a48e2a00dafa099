/// One substep, from top to bottom: substep.cpp is the list of its stages.
#pragma once

#include "engine/step/solve.h"
#include "engine/step/state.h"

namespace weft {

/// Computes the next state, in solved and next_velocity, by the scheme of the settings; position
/// and velocity stay. Where the solver gave up there is no next state.
Trial substep(State& s, const Attempt& attempt, StepReport& report, Team& team);

/// Lists who may touch whom at solved.
void find_contacts(State& s, StepReport& report);

}  // namespace weft
