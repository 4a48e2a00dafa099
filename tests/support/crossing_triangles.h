/// Which triangles of two surfaces cross or touch, by exact predicates (CGAL): it knows nothing of
/// how weft finds them.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstdint>
#include <vector>

namespace weft::test {

struct TriangleView {
  const std::vector<Vec3>& points;
  const std::vector<std::array<std::uint32_t, 3>>& triangles;
};

/// How many pairs of them have a point in common. Triangles without area count as segments.
int count_crossings(const TriangleView& a, const TriangleView& b);
/// Of one surface: pairs that have more in common than corners and edges that they share.
/// Neighbours that are folded flat onto each other along an edge do not count. A triangle whose
/// second and third corner are one is an edge.
int count_self_crossings(const TriangleView& surface);

}  // namespace weft::test
