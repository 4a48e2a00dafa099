/// One time step, from top to bottom.
#pragma once

#include <weft/weft.h>

#include "engine/state.h"

namespace weft {

/// Advances the state by h > 0, or leaves it as it was (Status::non_finite).
StepReport step(State& state, double h);

}  // namespace weft
