/// The bending elements of a mesh.
#pragma once

#include <vector>

#include "engine/mesh/edges.h"
#include "engine/mesh/stencils.h"

namespace weft::mesh {

/// The energy of an element for one face: with the stiffness k, k weight d^2 / 2. area: that it
/// stores, in m^2, before elements are calibrated.
struct Contribution {
  std::uint32_t stencil = 0;
  std::uint32_t face = 0;
  double weight = 0;
  double area = 0;
};

struct Stencils {
  std::vector<Stencil> stencils;
  std::vector<Contribution> contributions;
};

/// The elements of a mesh:
///  - at each end of an edge between two quads the bend of the yarn that crosses it there: three
///    points, and where the yarn turns within the cloth the edge's other end as well;
///  - in each quad its twist, which is the bend along its shorter diagonal;
///  - at other inner edges the bend between their two faces.
/// Hinges that are bent at rest keep both ends of their edge, which tell their side; rays
/// (rays.h) have none, and hinges around them tell it.
/// All are the isometric stencil of Bergou et al., "A Quadratic Bending Model for Inextensible
/// Surfaces", 2006, over the edge's length: 0 for any plane shape.
///
/// Together they store k c^2 / 2 per area for a cylinder of curvature c: in a grid of rectangles
/// exactly, for c^2 = Kxx^2 + Kyy^2 + 2 Kxy^2 is what warp, weft and twist read; elsewhere in the
/// mean over all directions. Faces at the border give what their border edges cannot store to the
/// other edges. weld_distance: as far apart may be what is one place of two faces; those that lie
/// farther apart are panels that are sewn: flat to each other, with an element in the places of
/// each. have_sides: all are hinges of four particles, whose fold may come to have a side.
Stencils bending_stencils(const std::vector<Face>& faces, const Edges& edges, double weld_distance,
                          bool have_sides);

/// m^2, per element: the part of the faces' area that is its own. Those of a face have all of it
/// together.
std::vector<double> areas_of(const Stencils& stencils, const std::vector<Face>& faces);

}  // namespace weft::mesh
