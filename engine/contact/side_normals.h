/// Normals of the features of a one-sided surface where an interval begins. The side of a point of
/// the cloth follows from the normal of the feature nearest to it (Baerentzen and Aanaes, 2005:
/// each triangle counts by its angle there). On the border of a surface that is open they are 0.
/// Each is computed when it is first asked for.
#pragma once

#include <cstdint>

#include "engine/sparse_array.h"
#include "engine/triangles/triangle_surface.h"
#include "kernels/vectors.h"

namespace weft {

class SideNormals {
 public:
  /// places: of the points of the surface. are_same: where they were before.
  void begin(const TriangleSurface& surface, const kernels::Vector* places, bool are_same);
  kernels::Vector of_triangle(std::uint32_t triangle);
  kernels::Vector of_edge(std::uint32_t triangle, std::size_t k);  // its k-th
  kernels::Vector of_edge(std::uint32_t edge);
  kernels::Vector of_point(std::uint32_t point);
  std::size_t bytes() const;

 private:
  struct Known {
    kernels::Vector normal;
    std::uint32_t interval;  // in which it was computed; 0: in none
  };
  template <class Compute>
  kernels::Vector known(SparseArray<Known>& normals, std::uint32_t i, Compute&& compute);

  const TriangleSurface* surface_ = nullptr;
  const kernels::Vector* places_ = nullptr;
  std::uint32_t interval_ = 0;
  SparseArray<Known> triangles_, edges_, points_;
};

}  // namespace weft
