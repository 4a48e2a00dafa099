/// Scheme rattle and its guard.
///
///     x' = x + h v + h^2/2 a + D,  D along the directions at x:    |x'_a - x'_b| = rest
///     v' = v + h a + D / h + K,    K along the directions at x':   n' . (v'_a - v'_b) = 0
///
/// The equations for x' are solved as everywhere, along directions that stay: errors are true ones,
/// and each renewal shrinks an error to 1 - cos of what its constraint turned by, times more the
/// more its neighbours turned against it.
///
/// Both kicks, D / h and K, are h/2 times the acceleration that the constraints cause, but for
/// O(h^2), and what they do to the energy cancels as far. Where h resolves the motion, gains and
/// losses alternate and stay small beside the kicks. Where it does not, because a tension T swings
/// a constraint faster than that (h^2 T / (m rest) of about 1), the solve diverges, or energy rises
/// by much of what a kick is worth. So a substep that gains more than kMostGain of the second kick
/// is refused. Two measures of the gain each count one thing too much, and the smaller one holds:
///
///     1/2 sum m |v'|^2 - m |v|^2 - 2 m a . (x' - x)    counts the work of moved pins, but for what
///                                                      is known of it (pin_work.h)
///     1/2 sum m |D/h|^2 - m |K|^2                      counts what an impact took, or velocities
///                                                      out of tolerance, as if it were gained
///
/// K must be applied even where velocities are within tolerance already, as they are where h is
/// small: solvers remove what is left of their errors too (hang, 40 x 40, 16 substeps, 1 %, by the
/// direct solver: 0 of 800 substeps fall back instead of 641).
///
/// Of what falls freely kicks are rounding, and gain is as often above as below 0. Lengths in
/// floats are off by up to 2^-24 of themselves, speeds by that over h: with edges of 0.1 m and
/// steps of 1 ms by 6e-6 m/s, and so the energy by 4e-9 of what it is after ten steps. 1e-9 is
/// allowed: a billion of them would double it.
///
/// Measured with yarns, strain 1e-6, 1e-4 m/s, one substep: without the guard hang 20 gains 0.11 J
/// (dt 0.01, 2 s). With 0.1, hang 10 to 40 and corners 21 and 41 gain nothing (dt 0.01, 0.005,
/// 0.0025), and corners 11 nothing in 2 s of 0.02 s; with 0.25 these gain up to 0.00015 J and
/// 0.0014 J. hang 20 refuses 11 of 200 steps of 0.01 s with 0.1 and 4 with 0.25. A bound on the
/// angle between n and n' is no criterion: a solve can diverge where no edge turns by much.
#pragma once

#include <algorithm>

#include "kernels/kicks.h"

namespace weft {

/// false for kicks that are not numbers, too.
inline bool keeps_energy(const kernels::Kicks& kicks) {
  constexpr double kMostGain = 0.1;
  constexpr double kRounding = 1e-9;  // of the energy, in positions that floats brought about
  const double allowed = kMostGain * kicks.second + kRounding * kicks.energy;
  return std::min(kicks.gain, kicks.first - kicks.second) <= allowed;
}

}  // namespace weft
