/// Rails in double: a smooth curve through the particles of a polyline (weft.h, Slider), which has
/// one direction everywhere, so that nothing that slides along it is slowed by a corner.
///
/// A piece of the curve leads from a particle 1 of the polyline to the next one, 2, and depends on
/// those around them, 0 and 3, too (Catmull and Rom, "A Class of Local Interpolating Splines",
/// 1974). At `share` 0 to 1 of it the point is the sum of weights times particles. The weights sum
/// to 1, so an impulse that the particles share by their weights acts at the point. Where a rail
/// ends, the polyline is taken as going straight on.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "kernels/vectors.h"

namespace weft::reference {

using RailWeights = std::array<double, 4>;

/// The weights of a point, and their first and second derivatives by the share.
struct RailBasis {
  RailWeights point{}, tangent{}, bend{};
};

/// The polyline goes on straight beyond particle 1 or 2.
inline void end_rail(RailWeights& w, bool begins, bool ends) {
  if (begins) {
    w[1] += 2 * w[0];
    w[2] -= w[0];
    w[0] = 0;
  }
  if (ends) {
    w[2] += 2 * w[3];
    w[1] -= w[3];
    w[3] = 0;
  }
}

inline RailBasis rail_basis(double t, bool begins, bool ends) {
  RailBasis basis{{0.5 * t * (-1 + t * (2 - t)), 1 + 0.5 * t * t * (-5 + 3 * t),
                   0.5 * t * (1 + t * (4 - 3 * t)), 0.5 * t * t * (-1 + t)},
                  {0.5 * (-1 + t * (4 - 3 * t)), 0.5 * t * (-10 + 9 * t),
                   0.5 * (1 + t * (8 - 9 * t)), 0.5 * t * (-2 + 3 * t)},
                  {2 - 3 * t, -5 + 9 * t, 4 - 9 * t, -1 + 3 * t}};
  for (RailWeights* w : {&basis.point, &basis.tangent, &basis.bend}) end_rail(*w, begins, ends);
  return basis;
}

inline kernels::Vector weighted(const RailWeights& w, const std::array<kernels::Vector, 4>& x) {
  return w[0] * x[0] + w[1] * x[1] + w[2] * x[2] + w[3] * x[3];
}

/// Where on a rail: `share` of a piece.
struct RailPlace {
  std::uint32_t piece = 0;
  double share = 0;
};

/// The nearest point of a rail, at least near where the search begins.
struct RailPoint {
  RailPlace place;
  RailWeights weights{};
  kernels::Vector way{};      // m, from the particle to the point
  kernels::Vector tangent{};  // of length 1, or 0
};

/// rail: pieces(), is_closed(), and around(piece), the four particles of a piece, as ways from the
/// particle that slides. The change of the share by Newton's method, or by that of Gauss and Newton
/// where the curve bends away.
template <class Rail>
RailPoint nearest_on_rail(const Rail& rail, RailPlace from) {
  constexpr int kMostSteps = 16;
  constexpr double kDone = 1e-7;  // of a piece
  RailPoint found{.place = from};
  const std::uint32_t last = rail.pieces() - 1;
  RailPlace& at = found.place;
  for (int i = 0;; ++i) {
    const std::array<kernels::Vector, 4> x = rail.around(at.piece);
    const RailBasis basis = rail_basis(at.share, at.piece == 0 && !rail.is_closed(),
                                       at.piece == last && !rail.is_closed());
    const kernels::Vector way = weighted(basis.point, x), along = weighted(basis.tangent, x);
    const double square = dot(along, along);
    const double bends = square + dot(way, weighted(basis.bend, x));
    const double size = std::sqrt(square);
    found.weights = basis.point;
    found.way = way;
    found.tangent = size > 0 ? (1 / size) * along : kernels::Vector{};
    if (!(square > 0) || i == kMostSteps) return found;
    const double by = std::clamp(-dot(way, along) / std::max(bends, 0.5 * square), -1.0, 1.0);
    const RailPlace before = at;
    at.share += by;
    if (at.share < 0 && (at.piece > 0 || rail.is_closed())) {
      at.piece = at.piece == 0 ? last : at.piece - 1;
      at.share += 1;
    } else if (at.share > 1 && (at.piece < last || rail.is_closed())) {
      at.piece = at.piece == last ? 0 : at.piece + 1;
      at.share -= 1;
    }
    at.share = std::clamp(at.share, 0.0, 1.0);
    const double moved = at.share - before.share;
    if (at.piece != before.piece || std::abs(moved) > kDone) continue;
    found.way = way + moved * along;  // across the rail, but where it ends
    return found;
  }
}

/// The largest share of the normal force that friction may hold where a cord turns by `angle` over
/// what slides on it: with it the tensions beside it differ by e^(friction angle), as Euler and
/// Eytelwein have it for a cord over a drum. Where it does not turn it is `friction`.
inline double friction_of_turn(double friction, double angle) {
  if (angle < 1e-6) return friction;
  return std::tanh(0.5 * friction * angle) / std::tan(0.5 * angle);
}

}  // namespace weft::reference
