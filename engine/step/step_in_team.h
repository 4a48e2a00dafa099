/// One time step of one cloth, by as many threads of a job system as are worthwhile.
#pragma once

#include <weft/weft.h>

#include "engine/step/state.h"

namespace weft {

/// As step() of step.h.
StepReport step_in_team(State& state, double dt, const JobSystem& jobs);

}  // namespace weft
