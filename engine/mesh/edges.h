/// The faces that meet at each edge.
#pragma once

#include <span>
#include <vector>

#include "engine/mesh/faces.h"

namespace weft::mesh {

struct EdgeOfFace {
  std::uint32_t face = 0;
  std::uint32_t side = 0;  ///< from this corner of the face to the next
};

struct Edge {
  std::uint32_t a = 0, b = 0;  ///< particles, a < b
  std::span<const EdgeOfFace> faces;
  bool is_inner() const { return faces.size() == 2; }
  bool is_border() const { return faces.size() == 1; }
};

/// Whether the two faces of an inner edge have it in different places at rest, farther apart than
/// weld_distance: each is in a panel of its own.
bool is_seam(const Edge& edge, const std::vector<Face>& faces, double weld_distance);

/// In the order of the faces and their sides.
class Edges {
 public:
  explicit Edges(const std::vector<Face>& faces);
  Edges(const Edges&) = delete;
  Edges& operator=(const Edges&) = delete;
  const std::vector<Edge>& all() const { return edges_; }
  const Edge& at(std::size_t face, std::size_t side) const { return edges_[of_[face][side]]; }

 private:
  std::vector<Edge> edges_;
  std::vector<EdgeOfFace> faces_;                 ///< of all edges, one edge after the other
  std::vector<std::array<std::uint32_t, 4>> of_;  ///< number of each face's sides
};

}  // namespace weft::mesh
