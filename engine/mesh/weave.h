/// Where warp and weft run in each face, and which quads are cells of them.
#pragma once

#include <weft/mesh.h>

#include <optional>
#include <vector>

#include "engine/mesh/edges.h"
#include "engine/mesh/faces.h"
#include "engine/mesh/woven_cell.h"

namespace weft::mesh {

/// Per face.
struct Weave {
  std::vector<Vec3> warp;  ///< unit vectors in the plane of the face
  std::vector<std::optional<WovenCell>> cells;
};

/// Where the mesh gives a warp (warp.h), that is it. Other faces make up parts, which end at seams.
/// A part that consists of woven cells by more than half is woven along its quads, and
/// faces between those continue what is beside them. In other parts the warp runs along y, as far
/// as y lies in the plane of the face; in parts that lie level, along x.
Weave weave_of(const MeshDescription& mesh, const std::vector<Face>& faces, const Edges& edges);

}  // namespace weft::mesh
