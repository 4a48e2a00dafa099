/// The loads of the cloth in a step, as far as they are known when it begins. The length of small
/// steps depends on them.
#pragma once

#include "engine/solvers/small_steps/small_steps_load.h"
#include "engine/step/state.h"

namespace weft {

/// m/s^2, of gravity and forces: the mean magnitude, by mass.
double mean_acceleration(const State& s);

/// A step of dt. It writes over solved and, with free spheres, contacts.
Burden burden_of(State& s, double dt);

}  // namespace weft
