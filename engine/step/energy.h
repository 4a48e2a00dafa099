/// Energy that the solution of constraints adds: the guard, and the test that rejects scheme
/// rattle.
///
/// Let D be the displacement of a particle by solving, and K the velocity that the velocity loop
/// adds. A substep is
///
///     x' = x + h v + h^2/2 a + D,    v' = v + h a + D / h + K
///
/// An error within tolerance is a loaded spring: its correction, D, comes back as the speed D / h,
/// which is larger in shorter substeps. Moreover, Newton's method or yarns may find a solution far
/// from the predicted positions: then the energy of D / h is gained. So all substeps but those of
/// the paper's own loop are guarded:
///
///     1/2 sum m |v'|^2 - m |v|^2 - 2 m a . (x' - x)  <=  work of moved pins
///
/// A gain beyond that is taken out of the velocities: all are slowed down by the same factor. With
/// pins under way, only the motion that differs from theirs is slowed down (pin_work.h).
///
/// Scheme rattle takes D along the directions at x and K along those at x'. Both are h/2 times the
/// acceleration by the constraints, up to O(h^2), and their effects on the energy cancel as far. If
/// h does not resolve the motion, because a tension T swings a constraint faster than that (h^2 T /
/// (m rest) of about 1), the gain is a large part of the energy of K. Two measures of the gain each
/// count one thing too much, and the smaller one holds:
///
///     1/2 sum m |v'|^2 - m |v|^2 - 2 m a . (x' - x)    counts the work of moved pins, but for what
///                                                      is known of it (pin_work.h)
///     1/2 sum m |D/h|^2 - m |K|^2                      counts what an impact took, or velocities
///                                                      out of tolerance, as if it were gained
#pragma once

#include "engine/step/state.h"

namespace weft {

/// Whether a substep by scheme rattle gains a large part of the energy of its impulses.
bool gains_energy(const State& s, const kernels::ImpulseEnergy& impulses, double h);

/// The guard of a substep by a solver, from (position, velocity) to (solved, next_velocity). Gains
/// below a share of the energy of its impulses are left alone, unless the substep is
/// suspect: another attempt was rejected before. Returns false if the velocities hold less energy
/// than the gain: then the substep has lifted its particles to a wrong place. Cheap if nothing is
/// gained. impulses.gain falls by the energy that is taken.
bool guard_energy(State& s, kernels::ImpulseEnergy& impulses, bool is_suspect, double h);

/// The guard of small steps. Constraints are springs here: energy that was lost shortly before
/// (`lost`, J) is stored in them, and may come back; and rounding takes it as often as it gives it.
/// Energy that springs and bending elements have released (J) is no gain. Cheap if no pins are
/// under way. change.gain falls by the energy that is taken. Returns State::lost_energy.
double guard_springs(State& s, double lost, double released, double h,
                     kernels::ImpulseEnergy& change);

// Its parts:
/// J, beyond the work of moved pins.
double gained_energy(const State& s, const kernels::ImpulseEnergy& change, double h);
/// Returns false if the velocities hold less. change.gain falls by the energy that is taken.
bool take_energy(State& s, double gain, double h, kernels::ImpulseEnergy& change);

}  // namespace weft
