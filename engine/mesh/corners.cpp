#include "engine/mesh/corners.h"

namespace weft::mesh {

Corners::Corners(const std::vector<Face>& faces, std::size_t particles) : first_(particles + 1, 0) {
  for (const Face& face : faces) {
    for (std::size_t i = 0; i < face.size; ++i) ++first_[face.particles[i] + 1];
  }
  for (std::size_t p = 0; p < particles; ++p) first_[p + 1] += first_[p];
  corners_.resize(first_[particles]);
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    for (std::uint32_t i = 0; i < faces[f].size; ++i) {
      corners_[next[faces[f].particles[i]]++] = {f, i};
    }
  }
}

}  // namespace weft::mesh
