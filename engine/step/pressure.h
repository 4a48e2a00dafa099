/// Pressures of weft.h: given ones, of enclosed gas, and of air that a piece of cloth catches.
///
/// A pressure p gives each corner of a triangle a third of p times its area vector. In small steps
/// that is found anew in every substep, and held during it. Its work is p times the volume that the
/// triangles sweep on straight ways: where p stands still that depends on the shape alone. What a
/// force that is held does beyond that counts as gained energy, and the guard takes it.
///
/// The pressure of a gas is found again where a sweep has ended: the volume V would swing far
/// faster than a substep is long. With k = -dp/dV, which is (p + ambient) / V, and the area vectors
/// a of the particles, all of them are moved by
///
///     d a (b h)^2 / m,    d = (p(V) - p) / (1 + k (b h)^2 sum a . a / m)
///
/// p is the pressure that the substep had so far. That is the implicit Euler method for the volume;
/// where the cloth holds the gas, d is 0.
///
/// Air that a piece catches presses as Air::ram says, but in h it takes from a free piece no more
/// than the velocity along its mouth.
#pragma once

#include "engine/step/state.h"

namespace weft {

class SmallSteps;

/// Whether triangles feel a pressure.
bool presses(const State& s);
/// State::pressed has the room that it needs, and total_force.
void make_room_for_pressure(State& s);
/// Air::ram, of pieces at x with the velocities v, for a time h from here on.
void find_ram(State& s, kernels::VectorsView x, kernels::VectorsView v, double h);
/// Pressures at x; State::total_force, to which State::pressed.beside is added, at x.
void press(State& s, kernels::VectorsView x);
/// After a sweep of a substep: gas gives way. x: where the particles are.
void let_gas_give_way(State& s, kernels::VectorsView x);
/// J, of the pressures between two places.
double work_of_pressure(const State& s, kernels::VectorsView from, kernels::VectorsView to);
/// N, of all pressures together.
kernels::Vector sum_of_pressure(const State& s, kernels::VectorsView x);
/// At these places.
PressureNow pressure_now(const Model& model, const Pressure& part, kernels::VectorsView x);

}  // namespace weft
