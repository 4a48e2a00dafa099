/// The direction of the warp that a mesh gives.
#pragma once

#include <weft/mesh.h>

#include <cstddef>

#include "engine/geometry.h"

namespace weft::mesh {

/// The warp that the mesh gives to a face: a unit vector in the plane of this normal. 0 where it
/// gives no direction, or one across the plane.
Vec3 given_warp(const MeshDescription& mesh, std::size_t face, Vec3 normal);

inline bool is_given(Vec3 warp) { return dot(warp, warp) > 0; }

}  // namespace weft::mesh
