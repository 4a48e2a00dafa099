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
  double fold = 0;                           // m, of a hinge
  bool yields = false;                       // a hinge whose fold may change
};

/// x: where particles are, by their slots.
template <class Places>
kernels::Vector weighted_sum(const BendingElement& e, const Places& x) {
  kernels::Vector d{0, 0, 0};
  for (std::size_t k = 0; k < 4; ++k) d = d + e.weights[k] * (x[e.slots[k]] - x[e.slots[2]]);
  return d;
}

inline bool has_three(const BendingElement& e) { return e.slots[2] == e.slots[3]; }

/// The arms of an element tell how it turns: one along it, and one across that. With four particles
/// each joins two whose weights have the same sign, so that the arms cross each other. With three
/// the first joins the ends, and the other the middle and the particle beside. A yarn by itself has
/// none, and takes d.
struct BendingArms {
  kernels::Vector along, across;
};
/// The order of its particles: the arms join 0 to 1 and 2 to 3, or the ends, 0 and 2. A hinge that
/// is folded at rest, or may come to be, keeps its order.
inline std::array<std::size_t, 4> order_of_arms(const BendingElement& e) {
  const auto& w = e.weights;
  const auto size = [&](std::size_t k) { return std::abs(w[k]); };
  std::array<std::size_t, 4> order{0, 1, 2, 3};
  if (e.fold != 0 || e.yields) return order;
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

/// The change of d since the substep began, in a frame that turns with the element: damping acts on
/// bending alone, and cloth that spins keeps its spin. The direction of d says
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

/// A normal of less than this share of |P| |d| is not made a unit: of two faces that lie on each
/// other it has no direction, and beyond 147 degrees it falls to nothing, so that a fold that goes
/// right over changes its side without a jump.
inline constexpr double kFlattestFold = 0.3;

/// A hinge that is folded at rest. Its edge P joins particles 0 and 1, and its faces reach from
/// there to 2 and 3: d is the sum of the ways to these, c_2 y_2 + c_3 y_3, and Q = c_3 y_3 - c_2
/// y_2 their difference, but for what goes along P. So N = P x Q is the sum of the faces' normals,
/// and where faces are as long as at rest, d stands along it. The energy of the element is
///
///     (|d|^2 - 2 fold g + fold^2) / (2 compliance),   g = d . n,   n = N / |N|,
///
/// that of |d - fold n|: a fold to the other side is none to this one.
///
/// Where faces lie nearly on each other n falls to nothing. So a fold at rest does not get there:
/// it would take more and more to press it flat. A hinge that yields does get there, since then its
/// rest is as flat. There n is along d, on the side on which it is, and does not turn with the
/// faces.
struct Hinge {
  kernels::Vector d, edge, across;  // d, P and Q
  kernels::Vector normal;           // n
  double size;                      // m, the divisor of N
  double g;
  bool is_flat;             // its faces lie nearly on each other, and size is kFlattestFold |P| |d|
  bool is_pressed = false;  // and it yields
};
template <class Places>
Hinge hinge_of(const BendingElement& e, const Places& x) {
  const kernels::Vector y1 = x[e.slots[1]] - x[e.slots[0]], y2 = x[e.slots[2]] - x[e.slots[0]],
                        y3 = x[e.slots[3]] - x[e.slots[0]];
  Hinge h{weighted_sum(e, x), y1, e.weights[3] * y3 - e.weights[2] * y2, {}, 0, 0, false};
  const kernels::Vector normal = cross(h.edge, h.across);
  const double full = length(normal), least = kFlattestFold * length(h.edge) * length(h.d);
  h.is_flat = full < least;
  h.size = std::max(full, least);
  if (h.size > 0) h.normal = (1 / h.size) * normal;
  h.g = dot(h.d, h.normal);
  h.is_pressed = h.is_flat && e.yields;
  if (h.is_pressed) h.g = std::copysign(length(h.d), h.g);
  return h;
}

/// rad, between the faces of a hinge, from -pi to pi; 0: flat. Since d is 2 r sin(angle / 2) long,
/// and Q across the edge 2 r cos(angle / 2), with r the reach of both faces.
inline double angle_of(const Hinge& h) {
  const double edge = length(h.edge);
  return edge > 0 ? 2 * std::atan2(h.g, h.size * length(h.normal) / edge) : 0;
}

/// m, the fold of a hinge that rests at this angle. arm: r, d per radian.
inline double fold_of(double arm, double angle) { return 2 * arm * std::sin(0.5 * angle); }
/// The inverse.
inline double angle_of_fold(double arm, double fold) {
  return 2 * std::asin(std::clamp(0.5 * fold / arm, -1.0, 1.0));
}

/// The forces on the particles of an element.
using Pulls = std::array<kernels::Vector, 4>;

/// The fall of the energy of a hinge, times its compliance. The second part, by which the normal
/// turns, is nothing where faces are as long as at rest. The linear system of bending does not know
/// it, and its stiffness is up to fold^2 (|P|^2 + 4 |Q|^2 / c^2) / |N|^2 times that of the first,
/// with c^2 the sum of the squares of weights. Where a substep does not resolve that, it counts by
/// a share. softness: compliance / W of the element, over what is just resolved.
inline Pulls pulls_of(const Hinge& h, const BendingElement& e, double softness) {
  const auto& w = e.weights;
  if (h.is_pressed) {
    const kernels::Vector of_d = (e.fold / h.g - 1) * h.d;
    return {w[0] * of_d, w[1] * of_d, w[2] * of_d, w[3] * of_d};
  }
  kernels::Vector by_d = h.normal, by_normal = h.d, along{0, 0, 0};
  if (h.is_flat) {
    by_d = by_d - h.g / dot(h.d, h.d) * h.d;
    along = h.g / dot(h.edge, h.edge) * h.edge;
  } else {
    by_normal = by_normal - h.g * h.normal;
  }
  by_normal = (h.size > 0 ? 1 / h.size : 0) * by_normal;
  const kernels::Vector of_d = e.fold * by_d - h.d;
  const double squares = w[0] * w[0] + w[1] * w[1] + w[2] * w[2] + w[3] * w[3];
  const double sides = dot(h.edge, h.edge) + 4 / squares * dot(h.across, h.across);
  const double stiffness = h.size > 0 ? e.fold * e.fold * sides / (h.size * h.size) : 0;
  const double turning = stiffness > softness ? softness / stiffness * e.fold : e.fold;
  const kernels::Vector of_across = turning * cross(by_normal, h.edge);
  const kernels::Vector of_edge = turning * (cross(h.across, by_normal) - along);
  Pulls pulls{};
  for (std::size_t k = 0; k < 4; ++k) pulls[k] = w[k] * of_d;
  pulls[0] = pulls[0] + (w[2] - w[3]) * of_across - of_edge;
  pulls[1] = pulls[1] + of_edge;
  pulls[2] = pulls[2] - w[2] * of_across;
  pulls[3] = pulls[3] + w[3] * of_across;
  return pulls;
}

/// (1 - rest / |d|) d
inline kernels::Vector beyond_rest(const BendingElement& e, kernels::Vector d) {
  const double square = dot(d, d);
  return (square > 0 ? 1 - e.rest / std::sqrt(square) : 1) * d;
}

/// The forces of the law
///
///     f = - ((1 - rest / |d|) d + damping bent) / compliance,   d = sum of c_i x_i,
///
/// of which particle i is pulled by c_i f. A hinge that is folded at rest has the first part of its
/// own energy. damping: the time constant over h. softness: as pulls_of has it.
inline Pulls pulls(const BendingElement& e, double damping, double softness, kernels::VectorsView x,
                   kernels::VectorsView start) {
  const double stiffness = 1 / e.compliance;
  Pulls pulls{};
  kernels::Vector f{0, 0, 0};
  if (e.fold == 0)
    f = beyond_rest(e, weighted_sum(e, x));
  else
    pulls = pulls_of(hinge_of(e, x), e, softness);
  if (damping != 0) f = f + damping * bent(e, x, start);
  for (std::size_t k = 0; k < 4; ++k)
    pulls[k] = stiffness * pulls[k] + e.weights[k] * (-stiffness * f);
  return pulls;
}

/// W, 1/kg
inline double inverse_mass_of(const BendingElement& e, const double* inverse_mass) {
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += inverse_mass[e.slots[k]] * e.weights[k] * e.weights[k];
  return sum;
}

/// m^2, twice the energy times the compliance.
template <class Places>
double bent_square(const BendingElement& e, const Places& x) {
  if (e.fold == 0) {
    const double bent = length(weighted_sum(e, x)) - e.rest;
    return bent * bent;
  }
  const Hinge h = hinge_of(e, x);
  return dot(h.d, h.d) - 2 * e.fold * h.g + e.fold * e.fold;
}

/// J. An element whose compliance / W is less than 1 / resolved has the energy of one with that.
inline double energy(const BendingElement& e, double resolved, const double* inverse_mass,
                     kernels::VectorsView x) {
  const double compliance = std::max(e.compliance, inverse_mass_of(e, inverse_mass) / resolved);
  return bent_square(e, x) / (2 * compliance);
}

}  // namespace weft::reference
