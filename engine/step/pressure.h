/// Pressures of weft.h: given ones, of enclosed gas, and of air that a piece of cloth catches.
///
/// A pressure p gives each corner of a triangle a third of p times its area vector. In small steps
/// that is found anew in every substep, and held during it. Its work is that of the mean of the
/// forces where the substep begins and ends: p times the volume that triangles sweep, up to the
/// third order. Work of a held force beyond that counts as gained energy, and the guard takes it.
/// The work of a gas follows from its volumes.
///
/// The volume of a gas would swing far faster than a substep is long. So a substep begins with the
/// pressure q that the last one came to, and finds another one, p, where its sweep has ended. With
/// the area vectors a of the particles and the volume V that the sweep came to, all of them are
/// moved by (p - q) a (b h)^2 / m, and p is that of the gas after it:
///
///     (ambient + p) (V + c (p - q)) = (ambient + pressure) volume,    c = (b h)^2 sum a . a / m
///
/// That is the implicit Euler method for the volume. Where the cloth holds the gas, p is q.
///
/// Air that a piece catches presses as Air::ram says, but in h it takes at most the velocity along
/// the mouth of a free piece.
#pragma once

#include <span>
#include <vector>

#include "engine/step/state.h"

namespace weft {

class SmallSteps;

/// Air::ram, of pieces at x with the velocities v, for a time h from here on.
void find_ram(State& s, kernels::VectorsView x, kernels::VectorsView v, double h);
/// 1/s, at which ram pressure would take the velocity of a piece that nothing else holds, where the
/// step begins.
double rate_of_ram(State& s);
/// Where a step begins: pressures of gas are those that the last one came to.
void begin_pressing(State& s);
/// LastingState::gas for other pressures: a gas with the same triangles keeps its own.
std::vector<double> gas_going_on(const State& s, std::span<const Pressure> next);
/// s, of the longest substep in which a sweep carries the tension by pressures, with the compliance
/// of the laws. The tension is that of a ball of the same area, T = p r / 2.
double length_for_pressure(const State& s);
/// Pressures at x, and State::total_force: that of pressures there, and State::pressed.beside.
void press(State& s, kernels::VectorsView x);
/// After a sweep of a substep: gas gives way. x: where the particles are.
void let_gas_give_way(State& s, kernels::VectorsView x);
/// J, of pressures from State::air_from to State::solved: where the last two calls of press were.
double work_of_pressure(const State& s);
/// N, of all pressures together, where the step begins.
kernels::Vector sum_of_pressure(const State& s);
/// At these places.
PressureNow pressure_now(const Model& model, const Pressure& part, kernels::VectorsView x);

}  // namespace weft
