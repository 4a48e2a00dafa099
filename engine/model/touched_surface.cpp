#include "engine/model/model.h"
#include "engine/model/threads.h"

namespace weft {

const TriangleSurface& Model::touched_surface() const {
  return touched_surface_.get([this] {
    std::vector<std::array<double, 3>> places;
    std::vector<std::uint32_t> loose;
    const std::vector<std::array<std::uint32_t, 2>> threads = find_threads(*this);
    std::vector<bool> is_joined(slots());
    for (const TriangleSurface::Triangle& triangle : surface) {
      for (const std::uint32_t corner : triangle) is_joined[corner] = true;
    }
    for (const auto& [a, b] : threads) is_joined[a] = is_joined[b] = true;
    for (std::uint32_t slot = 0; slot < slots(); ++slot) {
      const kernels::Vector x = initial_position[slot];
      places.push_back({x.x, x.y, x.z});
      if (!is_joined[slot] && inverse_mass[slot] > 0) loose.push_back(slot);
    }
    return make_triangle_surface(surface, places, loose, threads);
  });
}

}  // namespace weft
