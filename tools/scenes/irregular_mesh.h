/// An irregular mesh of triangles and quads over 1 m x 1 m, the mesh that perf/irregular_mesh
/// writes: the cloth of the scene `cape` and of the benchmarks named `irregular`.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace weft::scenes {

using Face = std::vector<std::uint32_t>;  ///< numbers of points, in order around the face

struct IrregularMesh {
  std::vector<Vec3> points;
  std::vector<Face> faces;
  std::vector<std::uint32_t> first_row;  ///< numbers of the points of the first row of cells
};

/// Size x size points near those of a level grid, moved along x and z by up to 0.3 of a spacing.
/// One diagonal per cell, chosen by chance; every tenth cell has none, every fiftieth is a hole.
/// Points and faces are in an order of chance. The same on every machine.
IrregularMesh irregular_mesh(int size);

/// Each once, in the order in which they are met around the faces.
std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_of(const std::vector<Face>& faces);

}  // namespace weft::scenes
