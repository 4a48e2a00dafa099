/// Splits a particle of a sheet into two, along edges of the sheet.
///
/// The triangles around a particle are its star. Those that share an edge at the particle, a spoke,
/// belong together; the parts are fans. A closed fan is cut along two spokes, the nearest to both
/// directions across the tension, and an open one along one spoke, which leads away from its
/// opening: so a crack goes on. The two triangles of a four-sided cell stay together.
#pragma once

#include <weft/scene.h>

#include <cstdint>
#include <vector>

#include "kernels/vectors.h"

namespace weft {

class SheetSplitter {
 public:
  /// x: of the particles, as described. Both grow by the particles that are added.
  SheetSplitter(SceneDescription& description, std::vector<kernels::Vector>& x);

  /// along: the tension. Returns the new particle, or kNoIndex where no edge can be cut.
  std::uint32_t split(std::uint32_t particle, kernels::Vector along);
  /// The ends of a constraint along an edge of the sheet; none: it runs along no edge. One on the
  /// border, where a crack ends, comes first, and a fixed one last.
  std::vector<std::uint32_t> ends_of_edge(const Constraint& constraint) const;

 private:
  SceneDescription& description_;
  std::vector<kernels::Vector>& x_;
  std::vector<bool> is_fixed_;
};

}  // namespace weft
