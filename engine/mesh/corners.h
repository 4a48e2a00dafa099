/// The corners of faces at each particle.
#pragma once

#include <span>
#include <vector>

#include "engine/mesh/faces.h"

namespace weft::mesh {

struct CornerOfFace {
  std::uint32_t face = 0;
  std::uint32_t corner = 0;
};

class Corners {
 public:
  Corners(const std::vector<Face>& faces, std::size_t particles);
  /// In the order of the faces.
  std::span<const CornerOfFace> at(std::uint32_t particle) const {
    return std::span(corners_).subspan(first_[particle], first_[particle + 1] - first_[particle]);
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<CornerOfFace> corners_;  ///< one particle after the other
};

}  // namespace weft::mesh
