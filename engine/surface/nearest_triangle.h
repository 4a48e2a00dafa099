/// The nearest of many triangles, by a tree of boxes. For meshes at rest; used while a surface is
/// mapped, and by nothing that moves.
#pragma once

#include <weft/scene.h>

#include <array>
#include <span>
#include <vector>

#include "engine/surface/drawn_mesh.h"

namespace weft::surface {

/// Shares of the corners of a triangle: a place in its plane.
using Shares = std::array<double, 3>;

struct Nearest {
  std::uint32_t triangle = kNoIndex;  ///< kNoIndex: there is none
  Shares shares{};                    ///< of the nearest point of it
  double distance = 0;                ///< m
};

class NearestTriangle {
 public:
  /// Triangles without an area are left out. Both must outlive this.
  NearestTriangle(std::span<const Vec3> points, std::span<const Triangle> triangles);
  bool is_empty() const { return nodes_.empty(); }
  /// Among several that are as near, where an edge or a corner is, it is that which the place is
  /// beside the least: so that places beside a border are told by triangles before them.
  Nearest operator()(Vec3 place) const;

 private:
  struct Node {
    Vec3 least{}, most{};
    std::uint32_t first = 0, count = 0;  // in order_; count 0: the children are the next node
    std::uint32_t other = 0;             // and this one
  };
  struct Search;
  void build(std::uint32_t first, std::uint32_t count);
  void bound(Node& node) const;
  void visit(std::uint32_t node, Search& search) const;
  void look_at(std::uint32_t triangle, Search& search) const;

  std::span<const Vec3> points_;
  std::span<const Triangle> triangles_;
  std::vector<Vec3> centres_;
  std::vector<std::uint32_t> order_;  // triangles, those of a leaf together
  std::vector<Node> nodes_;
};

}  // namespace weft::surface
