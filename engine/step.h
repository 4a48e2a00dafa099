/// One time step: its substeps, and what becomes of them. The list of stages is in substep.cpp.
#pragma once

#include <weft/weft.h>

#include "engine/state.h"

namespace weft {

/// Advances the state by dt > 0, or leaves it as it was: where committed(status) is false, and
/// where it throws.
StepReport step(State& state, double dt);

}  // namespace weft
