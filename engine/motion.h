/// The stages predict and commit, on either backend.
#pragma once

#include "engine/state.h"

namespace weft {

/// solved: where the particles would be after h without constraints.
void predict(State& s, double h, Team& team);
/// next_velocity: from solved. Returns whether both are finite.
bool commit(State& s, double h, Team& team);
/// What the impulses of a substep did (engine/rattle.h).
kernels::Kicks measure_kicks(State& s, double h, Team& team);

}  // namespace weft
