/// Bending elements in double, one after the other: what the vector kernels
/// (kernels/simd/bending.h) are held against.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "kernels/vectors.h"

namespace weft::reference {

struct BendingElement {
  std::array<std::uint32_t, 4> slots;
  std::array<double, 4> weights;  // their sum is 0
  double rest, compliance;
};

inline kernels::Vector weighted_sum(const BendingElement& e, kernels::VectorsView x) {
  kernels::Vector d{0, 0, 0};
  for (std::size_t k = 0; k < 4; ++k) d = d + e.weights[k] * (x[e.slots[k]] - x[e.slots[2]]);
  return d;
}

/// The square of the sine by which an element may turn in a substep and be taken to turn.
inline constexpr double kMostTurn = 0.25;

/// What d was when the substep began, s, turned as the element has turned since: the damping of an
/// element is about what it bends, and cloth that spins keeps its spin. Where d points elsewhere
/// altogether it has not turned, but bent the other way, and this is s itself.
inline kernels::Vector turned(kernels::Vector d, kernels::Vector s) {
  const double dd = dot(d, d), ss = dot(s, s), ds = dot(d, s);
  if (!(ds > 0)) return s;
  const double sine = 1 - ds * ds / (dd * ss);
  const double part = std::max(0.0, 1 - sine / kMostTurn);
  return (part * std::sqrt(ss / dd)) * d + (1 - part) * s;
}

/// The force f of the law
///
///     f = - (|d| - rest + damping (|d| - |s|)) d / |d| / compliance,   d = sum of c_i x_i,
///
/// of which particle i is pulled by c_i f. damping: the time constant over h, s: d of where the
/// particles were when the substep began.
inline kernels::Vector pull(const BendingElement& e, double damping, kernels::VectorsView x,
                            kernels::VectorsView start) {
  const kernels::Vector d = weighted_sum(e, x);
  const double square = dot(d, d);
  if (square == 0 && damping == 0) return {0, 0, 0};
  const double bent = square > 0 ? 1 - e.rest / std::sqrt(square) : 1;
  const kernels::Vector f = bent * d;
  if (damping == 0) return (-1 / e.compliance) * f;
  return (-1 / e.compliance) * (f + damping * (d - turned(d, weighted_sum(e, start))));
}

/// W, 1/kg
inline double inverse_mass_of(const BendingElement& e, const double* inverse_mass) {
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += inverse_mass[e.slots[k]] * e.weights[k] * e.weights[k];
  return sum;
}

/// J. An element whose compliance / W is less than 1 / resolved has the energy of one with that.
inline double energy(const BendingElement& e, double resolved, const double* inverse_mass,
                     kernels::VectorsView x) {
  const double bent = length(weighted_sum(e, x)) - e.rest;
  return bent * bent / (2 * std::max(e.compliance, inverse_mass_of(e, inverse_mass) / resolved));
}

}  // namespace weft::reference
