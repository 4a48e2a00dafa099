#include "engine/mesh/edges.h"

#include "engine/mesh/pair_numbers.h"

namespace weft::mesh {

bool is_seam(const Edge& edge, const std::vector<Face>& faces, double weld_distance) {
  const auto ends = [&](const EdgeOfFace& of) {
    const Face& face = faces[of.face];
    const std::size_t from = of.side, to = face.next(from);
    const bool is_forward = face.particles[from] == edge.a;
    return std::array{face.places[is_forward ? from : to], face.places[is_forward ? to : from]};
  };
  if (!edge.is_inner()) return false;
  const auto one = ends(edge.faces[0]), two = ends(edge.faces[1]);
  return length(one[0] - two[0]) > weld_distance || length(one[1] - two[1]) > weld_distance;
}

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
