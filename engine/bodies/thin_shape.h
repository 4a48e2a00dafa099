/// Shapes that may fit between the particles of a cloth, as surfaces for contacts with its edges
/// and faces, too. A ball is a point with a radius, a capsule a thread with a radius, and a hull is
/// its faces. A capsule whose radius changes pushes across its axis.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/bodies/mesh_shape.h"
#include "engine/gaps.h"
#include "kernels/reference/forms.h"

namespace weft {

/// A thread through these places: radii, of each, are what is solid around. Without links there is
/// one place, a ball.
MeshShape thin_thread(std::span<const kernels::Vector> places, std::vector<double> radii,
                      std::span<const std::array<std::uint32_t, 2>> links);
MeshShape thin_capsule(const reference::Round& capsule);
/// points: those of the hull.
MeshShape thin_hull(std::span<const kernels::Vector> points);
/// The least and the greatest height of the points over a face of their hull.
Widths widths_of(std::span<const reference::Face> faces, std::span<const kernels::Vector> points);

/// The tree around the triangles of a mesh.
BoxTree tree_of(const MeshShape& mesh);

}  // namespace weft
