/// Shapes that may fit between the particles of a cloth, as surfaces that its edges and faces
/// touch, too. A ball is a point, and a capsule a thread, in the middle of what is solid. A hull is
/// its faces. The push of a capsule whose radius changes is across its axis.
#pragma once

#include <span>

#include "engine/bodies/mesh_shape.h"
#include "engine/gaps.h"
#include "kernels/reference/bodies.h"

namespace weft {

MeshShape thin_capsule(const reference::Solid& capsule);
/// points: those of the hull.
MeshShape thin_hull(std::span<const kernels::Vector> points);
/// The least and the greatest height of the points over a face of their hull.
Widths widths_of(std::span<const reference::Face> faces, std::span<const kernels::Vector> points);

/// The tree around the triangles of a mesh.
BoxTree tree_of(const MeshShape& mesh);

}  // namespace weft
