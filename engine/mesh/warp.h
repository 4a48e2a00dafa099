/// Where a mesh says that the warp runs.
#pragma once

#include <weft/mesh.h>

#include "engine/mesh/faces.h"

namespace weft::mesh {

/// What the mesh gives to a face: a unit vector in the plane of this normal. 0 where it gives no
/// direction, or one across the plane.
Vec3 given_warp(const MeshDescription& mesh, std::size_t face, Vec3 normal);

inline bool is_given(Vec3 warp) { return dot(warp, warp) > 0; }

/// Which sides of a quad are along the warp: 0 (and 2) or 1 (and 3).
std::uint32_t side_along(const Face& quad, Vec3 warp);

/// Whether all sides of a quad are along the warp or across it, to tuning::kMostDeviation; so that
/// its edges can be yarns. True where no warp is given.
bool follows(const Face& quad, Vec3 warp);

}  // namespace weft::mesh
