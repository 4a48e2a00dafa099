/// The convex hull of points in space.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/vectors.h"

namespace weft {

/// Triangles of the hull by the numbers of their points, seen counterclockwise from outside. Points
/// that lie within rounding of the hull are left out. Empty: all points lie in a plane.
std::vector<std::array<std::uint32_t, 3>> convex_hull(std::span<const kernels::Vector> points);

}  // namespace weft
