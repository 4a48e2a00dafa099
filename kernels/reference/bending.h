/// Bending elements in double, one after the other: what the vector kernels
/// (kernels/simd/bending.h) are held against.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "kernels/vectors.h"

namespace weft::reference {

struct BendingElement {
  std::array<std::uint32_t, 4> slots;
  std::array<double, 4> weights;  // their sum is 0
  double rest, compliance;
  std::optional<std::uint32_t> beside = {};  // a slot: one that three particles turn with
};

inline kernels::Vector weighted_sum(const BendingElement& e, kernels::VectorsView x) {
  kernels::Vector d{0, 0, 0};
  for (std::size_t k = 0; k < 4; ++k) d = d + e.weights[k] * (x[e.slots[k]] - x[e.slots[2]]);
  return d;
}

/// A vector that has become shorter than this part of itself has no direction in floats.
inline constexpr double kVanished = 0x1p-20;

/// How v moves where it swings as `from` does, which moves by `by`: all of it up to 60 degrees,
/// and nothing from a right angle on.
inline kernels::Vector swing(kernels::Vector v, kernels::Vector from, kernels::Vector by) {
  const kernels::Vector to = from + by;
  const double was = length(from), size = was * std::max(length(to), kVanished * was);
  if (!(size > 0)) return {0, 0, 0};
  const double cosine = std::max(0.0, dot(from, to) / size);
  const kernels::Vector w = (1 / size) * cross(from, by), wv = cross(w, v);
  return std::min(1.0, 2 * cosine) * (wv + (1 / (1 + cosine)) * cross(w, wv));
}

inline bool has_three(const BendingElement& e) { return e.slots[2] == e.slots[3]; }

/// The arms of an element tell how it turns: one along it, and one across that. Of four particles
/// each joins two whose weights have the same sign, so that the arms cross each other. Of three the
/// first joins the ends, and the other the middle and the particle beside. A yarn by itself has
/// none, and takes d.
struct BendingArms {
  kernels::Vector along, across;
};
/// Of its particles: the arms join 0 to 1 and 2 to 3, or the ends, 0 and 2.
inline std::array<std::size_t, 4> order_of_arms(const BendingElement& e) {
  const auto& w = e.weights;
  const auto size = [&](std::size_t k) { return std::abs(w[k]); };
  std::array<std::size_t, 4> order{0, 1, 2, 3};
  if (has_three(e)) {
    if (size(0) > size(1) && size(0) > size(2)) order = {1, 0, 2, 2};
    if (size(2) > size(1) && size(2) > size(0)) order = {0, 2, 1, 1};
  } else if (w[0] * w[1] < 0 && w[2] * w[3] < 0) {
    std::swap(order[1], order[w[0] * w[2] > 0 ? 2 : 3]);
  }
  return order;
}
inline BendingArms arms(const BendingElement& e, kernels::VectorsView x) {
  const auto order = order_of_arms(e);
  const auto arm = [&](std::size_t a, std::size_t b) {
    return x[e.slots[order[a]]] - x[e.slots[order[b]]];
  };
  if (!has_three(e)) return {arm(0, 1), arm(3, 2)};
  const std::uint32_t middle = e.slots[order[1]];
  return {arm(0, 2), e.beside ? x[*e.beside] - x[middle] : weighted_sum(e, x)};
}

/// How d has changed since the substep began, for one who turns with the element: the damping of an
/// element is about what it bends, and cloth that spins keeps its spin. The direction of d says
/// nothing of a fine cell, where most of d is what sweeps have left.
inline kernels::Vector bent(const BendingElement& e, kernels::VectorsView x,
                            kernels::VectorsView start) {
  const kernels::Vector s = weighted_sum(e, start);
  const BendingArms was = arms(e, start), now = arms(e, x);
  const kernels::Vector by = now.along - was.along;
  const kernels::Vector swung = s + swing(s, was.along, by),
                        across = was.across + swing(was.across, was.along, by);
  const double square = dot(now.along, now.along);
  const auto beside = [&](kernels::Vector v) {
    return square > 0 ? v - (dot(v, now.along) / square) * now.along : v;
  };
  return weighted_sum(e, x) - swung - swing(swung, beside(across), beside(now.across - across));
}

/// The force f of the law
///
///     f = - ((1 - rest / |d|) d + damping bent) / compliance,   d = sum of c_i x_i,
///
/// of which particle i is pulled by c_i f. damping: the time constant over h.
inline kernels::Vector pull(const BendingElement& e, double damping, kernels::VectorsView x,
                            kernels::VectorsView start) {
  const kernels::Vector d = weighted_sum(e, x);
  const double square = dot(d, d);
  if (square == 0 && damping == 0) return {0, 0, 0};
  const double part = square > 0 ? 1 - e.rest / std::sqrt(square) : 1;
  const kernels::Vector f = part * d;
  if (damping == 0) return (-1 / e.compliance) * f;
  return (-1 / e.compliance) * (f + damping * bent(e, x, start));
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
