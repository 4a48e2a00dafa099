/// The topology of a surface of triangles: its edges, and how they belong together.
///
/// Each edge and each point is owned by one triangle. Two features of two surfaces are near to each
/// other only if their owners are: so pairs of triangles name each pair of features once.
#pragma once

#include <weft/scene.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/lists.h"

namespace weft {

struct TriangleSurface {
  using Triangle = std::array<std::uint32_t, 3>;

  /// Faces, then threads, then points alone. A thread, an edge that is in no face, has its second
  /// end twice: its first edge is the thread. A point has three equal corners.
  std::vector<Triangle> triangles;
  bool has_threads = false;
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<Triangle> edges_of;  // per triangle: k joins the corners k and k + 1; of a thread all
                                   // three are its one edge
  std::vector<std::array<std::uint32_t, 2>> opposite;  // per edge: the third corners of its first
                                                       // two triangles; kNoIndex: there is none
  std::vector<std::uint8_t> owns;       // per triangle: bit k its corner k, bit 3 + k its edge k
  Lists triangles_at;                   // per point: faces and threads
  Lists neighbours;                     // per point: the points that an edge joins it to
  std::vector<std::uint32_t> in_order;  // triangles, so that neighbours stand near to each other

  bool is_point(std::uint32_t triangle) const {
    return triangles[triangle][0] == triangles[triangle][1];
  }
  bool is_thread(std::uint32_t triangle) const {
    return triangles[triangle][1] == triangles[triangle][2] && !is_point(triangle);
  }
  bool is_face(std::uint32_t triangle) const {
    return triangles[triangle][1] != triangles[triangle][2];
  }
  bool is_thread_edge(std::uint32_t edge) const { return opposite[edge][0] == kNoIndex; }
  /// Whether the faces of a point that is in faces do not go all around it.
  bool is_on_border(std::uint32_t point) const {
    return neighbours[point].size() > triangles_at[point].size();
  }
  bool owns_corner(std::uint32_t triangle, std::size_t k) const { return owns[triangle] >> k & 1; }
  bool owns_edge(std::uint32_t triangle, std::size_t k) const {
    return owns[triangle] >> (3 + k) & 1;
  }
  std::size_t bytes() const;
};

/// places: x y z of each point, in some typical state, by which triangles are put in order.
/// loose: points that are to be there though no triangle has them.
/// threads: edges that are to be there though no triangle has them.
TriangleSurface make_triangle_surface(std::span<const TriangleSurface::Triangle> triangles,
                                      std::span<const std::array<double, 3>> places,
                                      std::span<const std::uint32_t> loose,
                                      std::span<const std::array<std::uint32_t, 2>> threads = {});

}  // namespace weft
