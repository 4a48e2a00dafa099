/// The law of contact, in double: what the vector kernels (kernels/simd/contacts.h) are held
/// against.
///
/// A contact is four points with weights w_k, which sum to 0, a unit normal n and a gap g: a point
/// beside a triangle, or two edges. Normal and weights are frozen where a substep begins. There no
/// feature has crossed another one, so the normal has the right side by itself. With W_k the
/// inverse masses, x_k the ways of the points since then, and S = sum of W_k w_k^2, a visit does
///
///     more = max(-(n . sum w_k x_k + g0 - t + a push) / (S + a), -push);   push += more
///     hold <- hold - slip / (S + a), shortened to friction times push
///     x_k += W_k w_k (more n + change of hold)
///
/// where g0 is the gap when the substep begins, slip the part of sum w_k x_k across n, and a =
/// kSlack S. The target t is the thickness; a pair that is nearer keeps the gap that it has, and
/// comes out of it by a small share of what is missing. So a multiplier knows the motion of the
/// substep alone. (If it knew the error of position, a stack whose sweep corrects less than half of
/// an error would gain energy from multipliers that the next substep begins with.)
///
/// Multipliers accumulate over visits: a later one takes back what was too much, and friction
/// follows the load. The next substep begins with them, but with no more than what pushed in the
/// substep before, too: a force that goes on pushes in both. An impact pushes in one, and would
/// throw apart what has met if it acted again.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "kernels/reference/distances.h"
#include "kernels/vectors.h"

namespace weft::reference {

/// The compliance of a contact, over its S.
inline constexpr double kSlack = 0.01;
/// S is not below this share of the largest inverse mass: a particle that has a small part in the
/// nearest point of what is fixed otherwise is not thrown far.
inline constexpr double kLeastGive = 0.05;
/// Edges touch within both, this share of their lengths off the ends, where the square of the sine
/// between them is more than the second.
inline constexpr double kLeastWithin = 1e-4, kLeastCrossing = 1e-6;
/// A normal stands in the cones of its features: what leans over a face beside an edge, or beside
/// the side of a triangle on which the nearest point lies, is taken off, and this share of the
/// distance has to be left. Else the contact is a neighbour's.
inline constexpr double kLeastLeft = 0.5;

struct Contact {
  std::array<double, 4> weight{};
  std::array<double, 4> inverse_mass{};
  Vector normal{};
  double gap = 0;    // m, over the target when the substep begins: g0 - t
  double slack = 0;  // 1/kg
  double give = 0;   // kg: 1 / (S + a); 0: it is left to a neighbour
  double friction = 0;
  double push = 0;    // kg m
  Vector hold{};      // kg m
  double before = 0;  // kg m: the push that the last substep ended with

  /// When a substep begins and its normal is frozen. share: its (b h)^2 over that of the last
  /// substep. The least push of the last two substeps acts again. Friction is shortened as the push
  /// is, and lies in the plane of now.
  void act_again(double share) {
    const double by = give == 0 ? 0 : share, last = by * push;
    push = std::min(last, by * before);
    before = last;
    hold = by * (push < last ? push / last : 1) * hold;
    hold = hold - dot(hold, normal) * normal;
  }
  /// One visit. x: ways of the points since the substep began, which it changes.
  void visit(std::array<Vector, 4>& x) {
    if (give == 0) return;
    Vector way{};
    for (std::size_t k = 0; k < 4; ++k) way = way + weight[k] * x[k];
    const double along = dot(normal, way);
    const double more = std::max(-(gap + along + slack * push) * give, -push);
    push += more;
    const Vector slip = way - along * normal;
    Vector held = hold - give * slip;
    const double l = length(held), most = friction * push;
    if (l > most) held = (most / l) * held;
    const Vector by = more * normal + (held - hold);
    hold = held;
    for (std::size_t k = 0; k < 4; ++k) x[k] = x[k] + inverse_mass[k] * weight[k] * by;
  }
};

/// m: g0 - t. recovery: of what is missing of the thickness so much comes out.
inline double gap_over_target(double gap, double thickness, double recovery) {
  return gap >= thickness ? gap - thickness : recovery * (gap - thickness);
}

}  // namespace weft::reference
