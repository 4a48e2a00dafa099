#include "engine/mesh/edges.h"

#include "engine/mesh/pair_numbers.h"

namespace weft::mesh {

Edges::Edges(const std::vector<Face>& faces) : of_(faces.size()) {
  PairNumbers numbers(2 * faces.size());
  std::vector<std::uint32_t> counts;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Face& face = faces[f];
    for (std::size_t side = 0; side < face.size; ++side) {
      const auto [a, b] = std::minmax(face.particles[side], face.particles[face.next(side)]);
      const auto [number, is_new] = numbers.add(a, b);
      if (is_new) {
        edges_.push_back({a, b, {}});
        counts.push_back(0);
      }
      ++counts[number];
      of_[f][side] = number;
    }
  }
  std::vector<std::size_t> next(counts.size(), 0);
  std::size_t sum = 0;
  for (std::size_t e = 0; e < counts.size(); ++e) {
    next[e] = sum;
    sum += counts[e];
  }
  faces_.resize(sum);
  for (std::size_t e = 0; e < counts.size(); ++e) {
    edges_[e].faces = std::span(faces_).subspan(next[e], counts[e]);
  }
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    for (std::uint32_t side = 0; side < faces[f].size; ++side) {
      faces_[next[of_[f][side]]++] = {f, side};
    }
  }
}

}  // namespace weft::mesh
