/// Scheme rattle and its guard.
///
///     x' = x + h v + h^2/2 a + D,   D along the constraints' directions at x,   |x'_a - x'_b| =
///     rest v' = v + h a + D / h + K,     K along those at x',                  n' . (v'_a - v'_b)
///     = 0
///
/// The equations for x' are solved as everywhere, along directions that stay: errors are true ones,
/// and each renewal shrinks an error to 1 - cos of what its constraint turned by, times more the
/// more its neighbours turned against it.
///
/// Both kicks, D / h and K, are h/2 times the acceleration that the constraints cause, but for
/// O(h^2), and what they do to the energy cancels as far. Where h resolves the motion, gains and
/// losses alternate and stay small beside the kicks. Where it does not, because a tension T swings
/// a constraint faster than that (h^2 T / (m rest) of about 1), the solve diverges, or energy rises
/// by much of what a kick is worth. So a substep is refused that gains more than kMostGain of the
/// second kick. Two measures of the gain each count one thing too much, and the smaller one holds:
///
///     1/2 sum m |v'|^2 - m |v|^2 - 2 m a . (x' - x)    counts the work of moved pins
///     1/2 sum m |D/h|^2 - m |K|^2                      counts what an impact took, or velocities
///                                                      out of tolerance, as if it were gained
///
/// Measured with the direct solver, 1e-7: without the guard hang 20 gains 0.11 J (dt 0.01, 2 s), by
/// steps that gain 0.1 to 8 times the second kick; with 0.1, 0.25 or 0.5 hang 10 to 40 and corners
/// 21 and 41 gain 0.00015 J at most (dt 0.01, 0.005, 0.0025) and hang 20 refuses 11, 5, 4 of 200
/// steps. A bound on the angle between n and n' is no criterion: corners 21 diverges at 0.005 s
/// where no edge turned by more than 11 degrees. A bound on the sum of gains instead of on each
/// refuses most steps after the first refusal (hang 20: 150 of 200).
#pragma once

#include <algorithm>

#include "kernels/kicks.h"

namespace weft {

/// false for kicks that are not numbers, too.
inline bool keeps_energy(const kernels::Kicks& kicks) {
  constexpr double kMostGain = 0.25;
  return std::min(kicks.gain, kicks.first - kicks.second) <= kMostGain * kicks.second;
}

}  // namespace weft
