/// Points of a cloth that seams join, open ones too: they are one point of the shape at rest.
/// Features with such a point in common do not collide, like features at one corner.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/contact/features.h"
#include "engine/lists.h"
#include "engine/model/model.h"

namespace weft {

class SewnPoints {
 public:
  SewnPoints() = default;
  explicit SewnPoints(const Model& model);

  bool empty() const { return first_.empty(); }
  /// The first of all points that seams join to this one.
  std::uint32_t first_of(std::uint32_t point) const { return empty() ? point : first_[point]; }
  TriangleSurface::Triangle first_of(const TriangleSurface::Triangle& triangle) const {
    return {first_of(triangle[0]), first_of(triangle[1]), first_of(triangle[2])};
  }
  bool is_one(std::uint32_t point, std::uint32_t other) const {
    return first_of(point) == first_of(other);
  }
  /// Whether both features of a pair of the cloth have a point in common.
  bool join(PairKind kind, const std::array<std::uint32_t, 4>& points) const {
    return !empty() && have_one_in_common(kind, points);
  }
  /// Triangles at all points that are one with this.
  std::span<const std::uint32_t> triangles_at(const TriangleSurface& cloth,
                                              std::uint32_t point) const {
    return empty() ? cloth.triangles_at[point] : triangles_at_[first_[point]];
  }
  std::size_t bytes() const;

 private:
  bool have_one_in_common(PairKind kind, const std::array<std::uint32_t, 4>& points) const;

  std::vector<std::uint32_t> first_;  // per slot; empty without seams
  Lists triangles_at_;                // per slot: none but at first ones
};

}  // namespace weft
