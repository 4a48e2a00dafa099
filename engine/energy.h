/// What is left where solvers fail becomes heat, never motion.
#pragma once

#include "engine/state.h"

namespace weft {

/// Slows next_velocity down, all of it by the same factor, as far as the energy from (position,
/// velocity) to (solved, next_velocity) rose by more than gravity and forces did; the work of moved
/// pins counts as a gain, too.
void take_gained_energy(State& s);

}  // namespace weft
