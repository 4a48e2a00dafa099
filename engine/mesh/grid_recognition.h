/// Grids whose cells were cut into triangles.
#pragma once

#include <vector>

#include "engine/mesh/faces.h"

namespace weft::mesh {

/// Puts quads in the place of pairs of triangles that are cells of a grid, each where its first
/// triangle was. Returns how many.
///
/// Two triangles are a cell if their common edge is the longest of both and the four corners are
/// near right angles. By chance this is so in any mesh, in a grid everywhere: a cell counts only if
/// all faces around one of its corners are cells or quads, four of them, or two at the border. No
/// cell lies across a seam (is_seam).
std::size_t recognise_grids(std::vector<Face>& faces, double weld_distance);

}  // namespace weft::mesh
