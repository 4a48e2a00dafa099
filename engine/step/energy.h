/// Energy that a substep brings about, and its answers.
///
/// With D, by how much solving moves a particle, a substep by scheme paper is
///
///     x' = x + h v + h^2/2 a + D,    v' = v + h a + D / h
///
/// Where x' is the place nearest to the prediction that keeps the constraints, it loses the energy
/// 1/2 sum m |D / h|^2 of its kick, or nearly, if x kept them. Newton's method, and yarns, may end
/// in another place that keeps them, far off, all within tolerance: the kick's energy is then
/// gained (random scenes: 0.78 to 1.0 times it).
#pragma once

#include "engine/step/state.h"

namespace weft {

/// Whether energy rose from (position, velocity) to (solved, next_velocity) by more than gravity,
/// forces and moved pins explain, and by much of what the kick is worth. kicks: of this substep.
bool gains_energy(const State& s, const kernels::Kicks& kicks, double h);

/// The guard of small steps does the same for a whole step whose change of energy is known. Energy
/// that was lost shortly before may come back (State::lost_energy): constraints are springs that
/// store it, and rounding takes it as often as it gives it. The guard is cheap if no pins are under
/// way.
void take_gained_energy(State& s, const kernels::Kicks& change, double dt);

/// Slows next_velocity down, all of it by the same factor, as far as the energy rose by more than
/// gravity, forces and moved pins explain; with pins under way what is slowed down is the motion
/// that differs from theirs (pin_work.h).
void take_gained_energy(State& s, double h);

}  // namespace weft
