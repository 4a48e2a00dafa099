/// Breaks when a step ends (Tear in weft/scene.h).
#pragma once

#include "engine/step/state.h"

namespace weft {

/// After a step that was committed. Breaks what carries more than its strength, and lets flanks
/// that are apart (flanks.h) touch each other: the state then has a model of its own, and
/// State::torn tells. Returns whether anything broke.
bool tear(State& state);

/// s, of the longest substep that solves as stiff as they are the springs and the triangles that
/// come near their strength; infinite where none does.
double substep_length_for_strengths(const State& state);

}  // namespace weft
