/// Breaks when a step ends (Tear in weft/scene.h).
#pragma once

#include "engine/step/state.h"

namespace weft {

/// After a step that was committed. Breaks what carries more than its strength, and lets flanks
/// that are apart (flanks.h) touch each other: the state then has a model of its own, and
/// State::torn tells. Returns whether anything broke.
bool tear(State& state);

}  // namespace weft
