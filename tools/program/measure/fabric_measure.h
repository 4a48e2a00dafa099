/// How far a cloth of fabric is stretched along its warp and its weft, and by how much it is
/// sheared.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstdint>
#include <vector>

#include "tools/program/measure/fabric_laws.h"

namespace weft::tools {

/// Component by component, of what is not negative.
FabricStrain largest(const FabricStrain& a, const FabricStrain& b);

/// Reads woven cells by their sides, whatever springs they are made of, and triangles by their
/// laws. Strains count as sizes, longer or shorter; what only pulls has none where it is slack, and
/// what lies between fixed particles has none at all. Here shear is an angle, rad.
class FabricMeasure {
 public:
  FabricMeasure() = default;
  /// cells: as MeshCloth::cells.
  FabricMeasure(const SceneDescription& scene,
                const std::vector<std::array<std::uint32_t, 4>>& cells);
  bool is_empty() const { return cells_.empty() && elements_.empty(); }
  /// The largest of each.
  FabricStrain operator()(const Cloth& cloth) const;

 private:
  struct Side {
    double length = 0;  ///< m at rest; 0: there is no spring
    bool is_rope = false;
  };
  struct Cell {
    std::array<std::uint32_t, 4> particles{};
    std::array<Side, 4> sides{};  ///< the first and the third along the warp
    double rest_angle = 0;        ///< rad, of warp and weft at rest beyond a right one
  };
  FabricStrain strain_of(const Cell& cell, const Cloth& cloth) const;
  FabricStrain strain_of(const MembraneElement& element, const Cloth& cloth) const;

  std::vector<Cell> cells_;
  std::vector<MembraneElement> elements_;
};

}  // namespace weft::tools
