/// Constraints that keep a mesh from stretching.
#pragma once

#include <vector>

#include "engine/mesh/edges.h"
#include "engine/mesh/welding.h"

namespace weft::mesh {

/// Every edge of a face and every line, rigid; then diagonals, if they are asked for. The first of
/// two that join the same particles counts.
std::vector<Constraint> rigid_constraints(const MeshDescription& mesh, const Welded& welded);

/// Elements that a material makes of faces and lines.
struct Fabric {
  /// Springs of woven cells: edges in the order of the faces, then diagonals.
  std::vector<Constraint> springs;
  std::vector<std::array<std::uint32_t, 4>> cells;  ///< their particles, as MeshCloth::cells
  /// Of other faces: one for each triangle, two for each quad, in the order of the faces. Edges
  /// against which the angles are wide are flipped (delaunay.h).
  std::vector<MembraneElement> membrane;
  std::vector<Constraint> threads;  ///< rigid: lines, but those along an edge or a diagonal
  std::vector<Face> parts;          ///< cells, and the triangles of all other faces
  std::size_t cut_again = 0;        ///< recognised quads that became no cells
};
Fabric fabric_of(const MeshDescription& mesh, const Welded& welded, const std::vector<Face>& faces,
                 const Edges& edges);

}  // namespace weft::mesh
