/// The sides of quads that are warp, and those that are weft.
#pragma once

#include <vector>

#include "engine/mesh/edges.h"

namespace weft::mesh {

/// Per face: 0 or 1, the first of its sides (0 and 2, or 1 and 3) that are warp; of triangles 0.
/// Carried from quad to quad across their common sides, but not across seams; where these
/// contradict each other, round a corner of three quads or five, the first way counts.
std::vector<std::uint32_t> warp_sides(const std::vector<Face>& faces, const Edges& edges,
                                      double weld_distance);

}  // namespace weft::mesh
