/// The substeps of a step: how many, and what is done where a solver gives up.
#pragma once

#include "engine/step/state.h"

namespace weft {

/// Advances the state by dt, or leaves it as it was and returns false. With jumped, pins have been
/// put down elsewhere: the start is projected onto the constraints, as one is that was given.
bool run_substeps(State& s, double dt, bool jumped, StepReport& report, Team& team);

}  // namespace weft
