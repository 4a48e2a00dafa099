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

/// The numbers of a visit: of a substep of h, with positions that move by (b h)^2 w f, and a force
/// that acts during n of them.
struct BendingVisit {
  double own = 1;      // 1 / omega
  double rate = 0;     // 1 / (n (b h)^2), 1/s^2
  double damping = 0;  // tau, s
  double most = 0;     // 1/s: tau is this times compliance / W at most
};

/// W, 1/kg
inline double inverse_mass_of(const BendingElement& e, const double* inverse_mass) {
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += inverse_mass[e.slots[k]] * e.weights[k] * e.weights[k];
  return sum;
}

inline kernels::Vector weighted_sum(const BendingElement& e, kernels::VectorsView x) {
  kernels::Vector d{0, 0, 0};
  for (std::size_t k = 0; k < 4; ++k) d = d + e.weights[k] * (x[e.slots[k]] - x[e.slots[2]]);
  return d;
}

/// The impulse mu = (b h)^2 n f, of which x_i moves by w_i c_i mu, that makes the law
///
///     (|d| - rest + tau d|d|/dt) d / |d| = - compliance f,   d = sum of c_i x_i
///
/// hold in the end of a sweep over elements that bend alike (kernels/simd/bending.h). The rate is
/// that of v, the velocity in the beginning of the substep.
inline void bend(const BendingElement& e, const BendingVisit& visit, const double* inverse_mass,
                 kernels::VectorsView x, kernels::VectorsView v) {
  const double inverse = inverse_mass_of(e, inverse_mass);
  const kernels::Vector d = weighted_sum(e, x);
  const double square = dot(d, d);
  if (square == 0) return;
  const double tau = std::min(visit.damping, visit.most * e.compliance / inverse);
  const double stretched =
      1 - e.rest / std::sqrt(square) + tau * dot(d, weighted_sum(e, v)) / square;
  const kernels::Vector mu =
      (-stretched / std::max(0.5 * inverse + visit.rate * e.compliance, visit.own * inverse)) * d;
  for (std::size_t k = 0; k < 4; ++k)
    x.add(e.slots[k], (inverse_mass[e.slots[k]] * e.weights[k]) * mu);
}

/// J. An element whose compliance / W is less than 1 / resolved has the energy of one with that.
inline double energy(const BendingElement& e, double resolved, const double* inverse_mass,
                     kernels::VectorsView x) {
  const double bent = length(weighted_sum(e, x)) - e.rest;
  return bent * bent / (2 * std::max(e.compliance, inverse_mass_of(e, inverse_mass) / resolved));
}

}  // namespace weft::reference
