/// A body that is a surface of triangles.
#pragma once

#include <vector>

#include "engine/triangles/triangle_surface.h"
#include "kernels/vectors.h"

namespace weft {

/// In coordinates of the body.
struct MeshShape {
  std::vector<kernels::Vector> vertices{};
  TriangleSurface surface{};
  bool two_sided = false;
  bool is_open = false;  // it has a border
};

}  // namespace weft
