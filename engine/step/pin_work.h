/// The work that moved pins do on a cloth in a substep.
///
/// Solvers do not keep the impulses at pins, but their sum is known: it is the sum of the impulses
/// J = m (v' - v - h a) that free particles receive besides gravity, forces and bodies. A pin of
/// velocity u with the impulse J does the work u . J. If all pins move as one rigid body,
/// u + s x (x - c), their work is
///
///     u . sum J  +  s . sum (x - c) x J
///
/// For pins that move otherwise this is the work of the rigid motion nearest to theirs (least
/// squares, each as often as it has constraints). Work beyond that, and that of moved spheres that
/// touch something, is not known: `stray` says how fast they do it. Points of anchors are pins that
/// hold one constraint, whether or not their particle is at its limit.
#pragma once

#include "engine/step/state.h"

namespace weft {

/// The motion of fixed particles and the points of anchors; 0 where none is under way.
struct PinMotion {
  kernels::Vector centre{}, velocity{}, spin{};  // u + s x (x - c), as above
  double stray = 0;                              // m/s, the most by which one moves otherwise

  kernels::Vector at(kernels::Vector x) const { return velocity + cross(spin, x - centre); }
};

/// Whether any is under way.
inline bool pins_move(const State& s) { return s.pins.moving() || s.anchors.moving(); }
/// Halfway through a substep of h from position, with velocity.
PinMotion motion_of_pins(const State& s, double h);

/// From (position, velocity) to (solved, next_velocity), J.
double work_of(const PinMotion& pins, const State& s, double h);
/// Pins that stray may give that speed to free particles that they hit: an energy, J, that is
/// accepted.
double stray_energy(const PinMotion& pins, const State& s);

}  // namespace weft
