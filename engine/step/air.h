/// Forces that depend on velocities: of the air, and the decay of all motion. In small steps motion
/// decays by itself (solvers/small_steps/small_steps.h): to them c is 0 here.
///
/// They are found at the start of a time h and held during it: for a substep by the exact solvers,
/// for one or a few by small steps (parts_for_air). With v the mean velocity of its corners
/// relative to the wind, a triangle of area A and unit normal n gives each corner, which moves with
/// v_i, a third of
///
///     f(v_i) = -(R v_i + S x v_i)
///     R = density / 2 drag A |n . v|
///     S = density / 2 lift A (n . v) (v x n) / |v|
///
/// Their sum is weft.h's force at v. Drag is a rate, at which motion is lost, and lift is a spin,
/// which turns it. Both are kept while the velocity changes: with R and S the sums over a
/// particle's triangles and m its mass, and with c the rate of decay (Damping::motion), h begins
/// with
///
///     v <- e^(-c h) v
///
/// and the acceleration during h is q (y + c v), v being the velocity before that, where
///
///     q = (1 - e^(-c h)) / (c h),    (1 + q h R / m) y + (q h S / m) x y
///                                        = g + (external + f) / m - c v
///
/// A free particle's velocity changes by q h y in all. It does not change if the forces balance, so
/// falling cloth reaches its terminal velocity at any h. Air at rest takes energy from a particle
/// at any h, however light it is: this is the implicit Euler method of a linear force that opposes
/// motion. Where constraints hold a particle against the air, R and S weaken and turn the other
/// forces on it, by a share of the order of h (R + |S|) / m.
#pragma once

#include "engine/step/state.h"

namespace weft {

/// State::total_force during h from here on, with the rate of decay c, but for pressures; and the
/// ram pressure. Only where State::total_force has a size.
void find_velocity_forces(State& s, double c, double h, Team& team);
/// The same for particles at x with the velocities v.
void find_velocity_forces(State& s, kernels::VectorsView x, kernels::VectorsView v, double c,
                          double h, Team& team);
/// How fast the air acts, in the mean over the cloth: with U the speed of the cloth relative to it,
/// C the sum of drag and lift, s the mass of the cloth per area and l the size of its cells,
///
///     rate = density / 2 C U / s        at which it takes the velocity of cloth across the wind
///     turning^2 = rate U / l            of a wave of one cell, which the wind turns
///
/// The rate of ram pressure (pressure.h) is added to the first one. It acts on no wave of a cell.
struct AirPace {
  double rate = 0, turning = 0;  // 1/s
};
/// 0 without air.
AirPace find_air_pace(State& s);
/// In how many parts of dt the forces are to be found anew, 1 or more. A triangle across the wind
/// that is turned along it loses its force, at once and not at the end of a step: in a part the air
/// is not to take more than the share tuning::kAirShare of a velocity.
double parts_for_air(const AirPace& pace, double dt);
/// State::velocity, before h.
void decay(State& s, double h);

}  // namespace weft
