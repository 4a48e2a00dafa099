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

/// A vector that goes from v - by / 2 to v + by / 2.
struct Way {
  kernels::Vector v, by;
};

/// How an element turns, by the ways of its arms: a vector along the axis, of twice the tangent of
/// half the angle. A turn takes any vector v from v - by / 2 to v + by / 2 where by = turn x v. No
/// arm turns the element by more than a right angle, and one that has turned about all by less.
inline kernels::Vector turn_of(const Way& along, const Way& across) {
  const auto bounded = [](double part, double square, double most) {
    const double size = std::max(square, 0.25 * most);
    return size > 0 ? part / size : 0;
  };
  const double square = dot(along.v, along.v);
  const kernels::Vector swing =
      bounded(1, square, dot(along.by, along.by)) * cross(along.v, along.by);
  const kernels::Vector rest = across.by - cross(swing, across.v),
                        normal = cross(along.v, across.v);
  const double twist = bounded(dot(normal, rest), dot(normal, normal), square * dot(rest, rest));
  return swing + twist * along.v;
}

/// Half of the sum of the weights' sizes, over which |d| is the distance of the particles of
/// positive weight, in their mean, from the others.
inline double reach_of(const BendingElement& e) {
  double sum = 0;
  for (const double w : e.weights) sum += 0.5 * std::abs(w);
  return sum;
}

/// How d has changed since the substep began, for one who turns with the element: the damping of an
/// element is about what it bends, and cloth that spins keeps its spin. The direction of d says
/// nothing of a fine cell, where most of d is what sweeps have left: there the arms tell how it
/// turns. In a sharp fold they say nothing, since the arm along it has all but vanished, and a
/// force that follows it feeds the fold: there d does. Each counts by its length squared.
inline kernels::Vector bent(const BendingElement& e, kernels::VectorsView x,
                            kernels::VectorsView start) {
  const auto way = [](kernels::Vector from, kernels::Vector to) {
    return Way{0.5 * (from + to), to - from};
  };
  const Way d = way(weighted_sum(e, start), weighted_sum(e, x));
  const BendingArms was = arms(e, start), now = arms(e, x);
  const Way along = way(was.along, now.along), across = way(was.across, now.across);
  const double reach = reach_of(e), flat = reach * reach * dot(along.v, along.v),
               sum = flat + dot(d.v, d.v);
  if (sum == 0) return {0, 0, 0};
  const kernels::Vector for_arms = d.by - cross(turn_of(along, across), d.v);
  return (1 / sum) * (flat * for_arms + dot(d.v, d.by) * d.v);
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
