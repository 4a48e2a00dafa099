/// Whether triangles cross.
#pragma once

#include <algorithm>
#include <array>

#include "engine/tuning.h"
#include "kernels/vectors.h"

namespace weft {

using Corners = std::array<kernels::Vector, 3>;

/// Six times the volume of the tetrahedron; its sign tells on which side of a b c d is.
inline double volume_of(kernels::Vector a, kernels::Vector b, kernels::Vector c,
                        kernels::Vector d) {
  return dot(cross(a - d, b - d), c - d);
}

/// A way that only touches the triangle does not lead through it. beyond: m, the least distance of
/// both ends on their sides; where it is below 0 they may be so far before it.
inline bool leads_through(kernels::Vector from, kernels::Vector to, const Corners& t,
                          double beyond = tuning::kTouching) {
  const double side = volume_of(t[0], t[1], t[2], from), other = volume_of(t[0], t[1], t[2], to);
  const double touches = beyond * length(cross(t[1] - t[0], t[2] - t[0]));
  if (std::min(side, other) >= -touches || std::max(side, other) <= touches) return false;
  const double turns[] = {volume_of(from, to, t[0], t[1]), volume_of(from, to, t[1], t[2]),
                          volume_of(from, to, t[2], t[0])};
  const auto [least, most] = std::ranges::minmax(turns);
  return least >= 0 || most <= 0;
}

/// All corners of one triangle are on one side of the other, farther than `beyond` (m).
inline bool are_beside(const Corners& one, const Corners& other,
                       double beyond = tuning::kTouching) {
  const kernels::Vector n = cross(other[1] - other[0], other[2] - other[0]);
  const double touches = beyond * length(n);
  const double at[] = {dot(n, one[0] - other[0]), dot(n, one[1] - other[0]),
                       dot(n, one[2] - other[0])};
  const auto [least, most] = std::ranges::minmax(at);
  return least > touches || most < -touches;
}

}  // namespace weft
