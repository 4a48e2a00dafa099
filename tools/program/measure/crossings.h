/// How many triangles of two surfaces cross: by exact geometry but for rounding, and by nothing
/// that the engine finds contacts with.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "tools/scenes/scene_body.h"

namespace weft::tools {

/// Triangles by their corners' places.
struct TriangleSet {
  std::vector<Vec3> places;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// All bodies that are meshes, as one, where they are at a time.
TriangleSet meshes_at(std::span<const SceneBody> bodies, double time);

/// Pairs of a triangle of `a` and one of `b` whose boxes, grown by `reach` (m), meet.
std::vector<std::pair<std::uint32_t, std::uint32_t>> near_pairs(const TriangleSet& a,
                                                                const TriangleSet& b, double reach);

/// Pairs of triangles of which an edge of one leads through the other. What only touches does not
/// cross.
std::size_t count_crossings(const TriangleSet& a, const TriangleSet& b);

}  // namespace weft::tools
