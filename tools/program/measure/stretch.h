/// How far the cloth is stretched around each particle: what a heat map shows.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace weft::tools {

/// Of the constraints, and of the warp and the weft of the triangles of fabric that a particle
/// belongs to, the strain of the largest size, with its sign: longer is positive. Diagonals of
/// woven cells are left out, since shear makes them longer. So are slack ropes, slack directions of
/// triangles that only pull, and all that lies between fixed particles.
class StretchMeasure {
 public:
  /// cells: as MeshCloth::cells.
  StretchMeasure(const SceneDescription& scene,
                 std::span<const std::array<std::uint32_t, 4>> cells);
  /// One per particle, whose position is given.
  std::vector<double> operator()(std::span<const Vec3> positions) const;

 private:
  std::vector<Constraint> constraints_;
  std::vector<MembraneElement> elements_;
};

/// Whether each constraint is a diagonal of a cell.
std::vector<bool> find_diagonals(std::span<const Constraint> constraints,
                                 std::span<const std::array<std::uint32_t, 4>> cells);

}  // namespace weft::tools
