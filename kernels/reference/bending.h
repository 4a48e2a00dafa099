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

/// The force f of the law
///
///     f = - (|d| - rest + tau d|d|/dt) d / |d| / compliance,   d = sum of c_i x_i,
///
/// of which particle i is pulled by c_i f. tau: s. The rate is that of v.
inline kernels::Vector pull(const BendingElement& e, double tau, kernels::VectorsView x,
                            kernels::VectorsView v) {
  const kernels::Vector d = weighted_sum(e, x);
  const double square = dot(d, d);
  if (square == 0) return {0, 0, 0};
  const double stretched =
      1 - e.rest / std::sqrt(square) + tau * dot(d, weighted_sum(e, v)) / square;
  return (-stretched / e.compliance) * d;
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
