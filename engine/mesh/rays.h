/// More bending elements, where those of edges and quads cannot bend alike in all directions.
#pragma once

#include <vector>

#include "engine/mesh/bending.h"

namespace weft::mesh {

/// Adds elements through these particles: from a corner around the particle straight on to where
/// the line leaves the faces on the other side. It leaves through a corner, or between two, whose
/// mean it then takes. Three at most at each particle, those that come nearest to a corner; that is
/// what a lattice of triangles has, and enough for any direction. Their weights are a third of the
/// faces'. Particles at the border, and where faces lie farther apart than weld_distance, have
/// none. particles: how many there are in all.
void add_rays(const std::vector<Face>& faces, const Edges& edges, double weld_distance,
              const std::vector<std::uint32_t>& through, std::size_t particles, Stencils& stencils);

}  // namespace weft::mesh
