#include "engine/mesh/edges.h"

#include <unordered_map>

#include "engine/mesh/pair_key.h"

namespace weft::mesh {

Edges::Edges(const std::vector<Face>& faces) : of_(faces.size()) {
  std::unordered_map<std::uint64_t, std::uint32_t> number_of;
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    const Face& face = faces[f];
    for (std::uint32_t side = 0; side < face.size; ++side) {
      const auto [a, b] = std::minmax(face.particles[side], face.particles[face.next(side)]);
      const auto next = static_cast<std::uint32_t>(edges_.size());
      const auto [entry, is_new] = number_of.try_emplace(pair_key(a, b), next);
      if (is_new) edges_.push_back({a, b, {}});
      edges_[entry->second].faces.push_back({f, side});
      of_[f][side] = entry->second;
    }
  }
}

}  // namespace weft::mesh
