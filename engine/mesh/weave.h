/// The directions of warp and weft in each face, and the quads that are woven cells.
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

/// A mesh consists of parts, which end at seams. In a part with faces that the mesh gives a warp to
/// (warp.h), as in flat panels, other faces continue what is beside them. Another part that
/// consists of woven cells by more than half is woven along its quads, and faces between those
/// continue what is beside them. In other parts the warp runs along y, as far as y lies in the
/// plane of the face; in parts that lie level, along x.
Weave weave_of(const MeshDescription& mesh, const std::vector<Face>& faces, const Edges& edges);

}  // namespace weft::mesh
