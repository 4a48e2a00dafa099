/// A step by small steps (engine/solvers/small_steps/small_steps.h), from its beginning to its end.
#pragma once

#include "engine/step/state.h"

namespace weft {

/// Returns whether all of dt was done; jumped: pins were put elsewhere before it.
bool run_small_steps(State& s, double dt, bool jumped, StepReport& report, Team& team);

}  // namespace weft
