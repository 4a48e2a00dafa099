/// Takes out the energy that what is left where a solver failed would add as motion.
#pragma once

#include "engine/state.h"

namespace weft {

/// Slows next_velocity down, all of it by the same factor, as far as the energy from (position,
/// velocity) to (solved, next_velocity) rose by more than gravity and forces did; the work of moved
/// pins counts as a gain, too.
void take_gained_energy(State& s);

}  // namespace weft
