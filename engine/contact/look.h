/// Pairs of features in double: where they are nearest to each other, and on which side of a
/// one-sided body the cloth is.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/contact/features.h"
#include "engine/contact/points.h"
#include "kernels/reference/distances.h"

namespace weft {

using FourPoints = std::array<kernels::Vector, 4>;

inline reference::Nearest nearest(PairKind kind, const FourPoints& x) {
  return kind == PairKind::edges ? reference::nearest_of_edges(x[0], x[1], x[2], x[3])
                                 : reference::nearest_in_triangle(x[0], x[1], x[2], x[3]);
}

/// Of `r`, which leads from the second feature of a pair to the first: from the body to the cloth.
inline double towards_cloth(PairKind kind) { return kind == PairKind::vertex_triangle ? -1 : 1; }

/// Whether the pair is one of its kind: edges meet within both. At an end of one they are near to
/// each other as its corner is to the other triangle.
inline bool is_in_place(PairKind kind, const reference::Nearest& nearest) {
  return kind != PairKind::edges || is_within_edges(nearest);
}

/// x: the points of the pair; at(point): where any point is. Whether another feature of one of both
/// surfaces is nearer than those of the pair: along n, which leads from the body to the cloth, a
/// neighbour stands out by more than the sine `lean`. What the pair would push along is no normal
/// of the surface then.
template <class At>
bool is_ghost(const TriangleSurface& cloth, const ContactMesh& mesh, const Pair& pair,
              const FourPoints& x, const reference::Nearest& nearest, kernels::Vector n,
              double lean, At&& at);

/// The normal of the body's surface where both are nearest; 0 on the border of an open mesh.
inline kernels::Vector side_normal(ContactMesh& mesh, const Pair& pair,
                                   const reference::Nearest& nearest) {
  SideNormals& normals = mesh.normals;
  if (pair.kind == PairKind::edges) return normals.of_edge(pair.of_body);
  if (pair.kind == PairKind::vertex_triangle) return normals.of_point(pair.of_body);
  const TriangleSurface::Triangle& t = mesh.mesh().surface.triangles[pair.of_body];
  switch (corners_of(nearest)) {
    case 1:
      return normals.of_point(t[0]);
    case 2:
      return normals.of_point(t[1]);
    case 4:
      return normals.of_point(t[2]);
    case 3:
      return normals.of_edge(pair.of_body, 0);
    case 6:
      return normals.of_edge(pair.of_body, 1);
    case 5:
      return normals.of_edge(pair.of_body, 2);
    default:
      return normals.of_triangle(pair.of_body);
  }
}

/// Features that are no farther apart touch: where they are does not tell on which side the cloth
/// is. It is in front of the surface then.
inline constexpr double kTouching = 1e-9;  // m

/// Whether the cloth is behind the surface of a one-sided body, where both are nearest.
inline bool is_behind(ContactMesh& mesh, const Pair& pair, const reference::Nearest& nearest,
                      kernels::Vector to_cloth) {
  return length(to_cloth) > kTouching && dot(side_normal(mesh, pair, nearest), to_cloth) < 0;
}

/// A unit vector from the second feature to the first: along r or, where they touch, along the
/// normal of the body.
inline kernels::Vector direction_apart(ContactMesh& mesh, const Pair& pair,
                                       const reference::Nearest& nearest) {
  const double l = length(nearest.r);
  if (l > kTouching) return (1 / l) * nearest.r;
  const TriangleSurface& surface = mesh.mesh().surface;
  kernels::Vector n = side_normal(mesh, pair, nearest);
  if (dot(n, n) == 0) {
    const std::uint32_t point =
        pair.kind == PairKind::edges ? surface.edges[pair.of_body][0] : pair.of_body;
    n = mesh.normals.of_triangle(
        pair.kind == PairKind::particle_triangle ? pair.of_body : surface.triangles_at[point][0]);
  }
  return towards_cloth(pair.kind) * kernels::direction(n, length(n));
}

// ------------------------------------------------------------------------------------------------

namespace contact_geometry {

/// Whether the third corner of a triangle beside the edge stands out along n, seen from x on it.
template <class At>
bool stands_out(const TriangleSurface& surface, std::uint32_t first, std::uint32_t edge,
                kernels::Vector x, kernels::Vector n, double lean, At&& at) {
  for (const std::uint32_t third : surface.opposite[edge]) {
    if (third == kNoIndex) continue;
    const kernels::Vector d = at(first + third) - x;
    if (dot(n, d) > lean * length(d)) return true;
  }
  return false;
}
template <class At>
bool neighbour_stands_out(const TriangleSurface& surface, std::uint32_t first, std::uint32_t point,
                          kernels::Vector n, double lean, At&& at) {
  const kernels::Vector x = at(first + point);
  for (const std::uint32_t other : surface.neighbours[point]) {
    const kernels::Vector d = at(first + other) - x;
    if (dot(n, d) > lean * length(d)) return true;
  }
  return false;
}

/// Of a triangle's nearest point; n leads from it to the other feature.
template <class At>
bool triangle_is_ghost(const TriangleSurface& surface, std::uint32_t first, std::uint32_t triangle,
                       const reference::Nearest& nearest, kernels::Vector n, double lean, At&& at) {
  const TriangleSurface::Triangle& t = surface.triangles[triangle];
  switch (corners_of(nearest)) {
    case 1:
      return neighbour_stands_out(surface, first, t[0], n, lean, at);
    case 2:
      return neighbour_stands_out(surface, first, t[1], n, lean, at);
    case 4:
      return neighbour_stands_out(surface, first, t[2], n, lean, at);
    case 3:
      return stands_out(surface, first, surface.edges_of[triangle][0], at(first + t[0]), n, lean,
                        at);
    case 6:
      return stands_out(surface, first, surface.edges_of[triangle][1], at(first + t[1]), n, lean,
                        at);
    case 5:
      return stands_out(surface, first, surface.edges_of[triangle][2], at(first + t[2]), n, lean,
                        at);
    default:
      return false;
  }
}

}  // namespace contact_geometry

template <class At>
bool is_ghost(const TriangleSurface& cloth, const ContactMesh& mesh, const Pair& pair,
              const FourPoints& x, const reference::Nearest& nearest, kernels::Vector n,
              double lean, At&& at) {
  using namespace contact_geometry;
  const TriangleSurface& body = mesh.mesh().surface;
  const kernels::Vector back = -1.0 * n;
  switch (pair.kind) {
    case PairKind::particle_triangle:
      return triangle_is_ghost(body, mesh.first_point, pair.of_body, nearest, n, lean, at);
    case PairKind::vertex_triangle:
      return triangle_is_ghost(cloth, 0, pair.of_cloth, nearest, back, lean, at);
    case PairKind::edges:
      break;
  }
  const kernels::Vector on_cloth = x[0] + nearest.weight[1] * (x[1] - x[0]);
  const kernels::Vector on_body = x[2] - nearest.weight[3] * (x[3] - x[2]);
  return stands_out(body, mesh.first_point, pair.of_body, on_body, n, lean, at) ||
         stands_out(cloth, 0, pair.of_cloth, on_cloth, back, lean, at);
}

}  // namespace weft
