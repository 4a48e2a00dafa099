/// Vertices that share a particle.
#pragma once

#include <weft/mesh.h>

#include <vector>

namespace weft::mesh {

struct Welded {
  std::vector<std::uint32_t> particle_of_vertex;  ///< kNoIndex: in no face and no line
  std::vector<Vec3> positions;                    ///< of particles
};

/// Numbers the particles in the order of their first vertices.
Welded weld(const MeshDescription& mesh);

}  // namespace weft::mesh
