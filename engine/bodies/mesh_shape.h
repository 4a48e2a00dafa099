/// A body that is a surface of triangles.
#pragma once

#include <vector>

#include "engine/triangles/box_tree.h"
#include "engine/triangles/triangle_surface.h"
#include "kernels/vectors.h"

namespace weft {

/// In coordinates of the body.
struct MeshShape {
  std::vector<kernels::Vector> vertices{};
  TriangleSurface surface{};
  BoxTree tree{};               // of its triangles
  std::vector<double> radii{};  // m, per vertex: what is solid reaches so far around; empty: 0
  double radius = 0;            // m, the largest of them
  bool two_sided = false;
  bool is_open = false;  // it has a border
};

}  // namespace weft
