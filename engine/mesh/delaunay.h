/// Better shaped triangles over the same particles.
#pragma once

#include <vector>

#include "engine/mesh/faces.h"

namespace weft::mesh {

/// The faces with edges between triangles flipped until the angles against each add up to half a
/// turn at most, as seen with both triangles unfolded into a plane. How a mesh bends and how stiff
/// its stiffest triangle is depends on the shape of its triangles, and which way a quad was cut
/// says nothing of the cloth. Quads stay, and so do edges whose faces lie farther apart than
/// weld_distance.
///
/// A flip takes the surface at rest from the two sides of a fold to a plane across it, and gives
/// both triangles the mean of their warps. most_change: edges stay where that would change more
/// than this share of the area, or of what the material does. Infinity: none does.
std::vector<Face> well_shaped(std::vector<Face> faces, double weld_distance, double most_change);

}  // namespace weft::mesh
