/// The pieces of a scene, and those that nothing holds.
#pragma once

#include <weft/weft.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace weft::mesh {

/// Particles are of one piece where constraints or triangles of fabric join them, over any number
/// of others. A sphere that is joined to nothing is no piece.
struct Pieces {
  /// From 0, in the order of their first particles; kNoIndex: of none.
  std::vector<std::uint32_t> of_particle;
  std::size_t count = 0;
  std::vector<bool> held;  ///< of each piece: it has a fixed particle, or an anchor
  std::size_t loose() const;
};
Pieces pieces_of(const SceneDescription& scene);

/// m, a power of ten: a distance that, as weld_distance of a mesh, would join pieces that nothing
/// holds to the rest, as far as they lie against it with gaps of a twentieth of an edge at most. 0:
/// there is none.
double joining_distance(const SceneDescription& scene, const Pieces& pieces);

}  // namespace weft::mesh
