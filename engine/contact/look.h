/// Pairs of features in double: their nearest points, the side of a one-sided surface on which the
/// other feature is, and whether neighbours are nearer.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "engine/contact/features.h"
#include "engine/contact/surface.h"
#include "engine/tuning.h"
#include "kernels/reference/distances.h"

namespace weft {

using FourPoints = std::array<kernels::Vector, 4>;

inline reference::Nearest nearest(PairKind kind, const FourPoints& x) {
  return kind == PairKind::edges ? reference::nearest_of_edges(x[0], x[1], x[2], x[3])
                                 : reference::nearest_in_triangle(x[0], x[1], x[2], x[3]);
}

/// Whether the pair is one of its kind: edges meet within both. At an end of one they are near to
/// each other as its corner is to the other triangle.
inline bool is_in_place(PairKind kind, const reference::Nearest& nearest) {
  return kind != PairKind::edges || is_within_edges(nearest);
}

/// x: the points of the pair; at(point): where any point is. Whether another feature of one of both
/// surfaces is nearer than those of the pair: along n, which leads from the second feature to the
/// first, a neighbour stands out by more than the sine `lean`. The direction of the push is no
/// normal of the surface then.
template <class At>
bool is_ghost(std::span<const ContactSurface> surfaces, const Pair& pair, const FourPoints& x,
              const reference::Nearest& nearest, kernels::Vector n, double lean, At&& at);

/// The surface that comes later tells thickness, friction and sides: a body's beside the cloth.
template <class Surfaces>
auto& later_surface(Surfaces&& surfaces, const Pair& pair) {
  return surfaces[std::max(pair.a, pair.b)];
}

/// The normal of the later surface where both are nearest; 0 on the border of an open one.
inline kernels::Vector side_normal(ContactSurface& later, const Pair& pair,
                                   const reference::Nearest& nearest) {
  SideNormals& normals = later.normals;
  if (pair.kind == PairKind::edges) return normals.of_edge(pair.second);
  if (pair.is_turned()) return normals.of_point(pair.first);
  const TriangleSurface::Triangle& t = later.triangles->triangles[pair.second];
  switch (corners_of(nearest)) {
    case 1:
      return normals.of_point(t[0]);
    case 2:
      return normals.of_point(t[1]);
    case 4:
      return normals.of_point(t[2]);
    case 3:
      return normals.of_edge(pair.second, 0);
    case 6:
      return normals.of_edge(pair.second, 1);
    case 5:
      return normals.of_edge(pair.second, 2);
    default:
      return normals.of_triangle(pair.second);
  }
}

/// Where features that are no farther apart are does not tell on which side the other surface is.
/// It is in front then.
using tuning::kTouching;

/// Whether the other surface is behind the later one, which is one-sided, where both are nearest.
inline bool is_behind(ContactSurface& later, const Pair& pair, const reference::Nearest& nearest) {
  return length(nearest.r) > kTouching &&
         dot(side_normal(later, pair, nearest), pair.outward() * nearest.r) < 0;
}

/// A pair at one moment.
struct Look {
  reference::Nearest nearest{};
  double distance = 0;       // m
  kernels::Vector normal{};  // a unit vector from the second feature to the first

  bool is_apart() const { return distance > kTouching; }
};

/// The normal of the later surface where they touch, that of a triangle if there is none. Where
/// that is in no face: one that is across both features.
inline kernels::Vector normal_where_touching(ContactSurface& later, const Pair& pair,
                                             const reference::Nearest& nearest,
                                             const FourPoints& x) {
  kernels::Vector n = side_normal(later, pair, nearest);
  if (dot(n, n) == 0) {
    const auto first_or_none = [](auto&& list) { return list.empty() ? kNoIndex : list[0]; };
    const TriangleSurface& surface = *later.triangles;
    std::uint32_t triangle = pair.second;
    if (pair.kind == PairKind::edges)
      triangle = first_or_none(surface.triangles_at[surface.edges[pair.second][0]]);
    else if (pair.is_turned())
      triangle = first_or_none(surface.triangles_at[pair.first]);
    if (triangle != kNoIndex) n = later.normals.of_triangle(triangle);
  }
  if (dot(n, n) == 0) {
    n = pair.kind == PairKind::edges ? cross(x[1] - x[0], x[3] - x[2])
                                     : cross(x[2] - x[1], x[3] - x[1]);
  }
  return pair.outward() * kernels::direction(n, length(n));
}

/// It has a normal only where both are apart.
inline Look look_apart(const Pair& pair, const FourPoints& x) {
  Look seen{.nearest = nearest(pair.kind, x)};
  seen.distance = length(seen.nearest.r);
  if (seen.is_apart()) seen.normal = (1 / seen.distance) * seen.nearest.r;
  return seen;
}

inline Look look(ContactSurface& later, const Pair& pair, const FourPoints& x) {
  Look seen = look_apart(pair, x);
  if (!seen.is_apart()) seen.normal = normal_where_touching(later, pair, seen.nearest, x);
  return seen;
}

// ------------------------------------------------------------------------------------------------

namespace ghosts {

/// Whether the third corner of a triangle beside the edge stands out along n, seen from x on it.
template <class At>
bool stands_out(const ContactSurface& surface, std::uint32_t edge, kernels::Vector x,
                kernels::Vector n, double lean, At&& at) {
  for (const std::uint32_t third : surface.triangles->opposite[edge]) {
    if (third == kNoIndex) continue;
    const kernels::Vector d = at(surface.first_point + third) - x;
    if (dot(n, d) > lean * length(d)) return true;
  }
  return false;
}
template <class At>
bool neighbour_stands_out(const ContactSurface& surface, std::uint32_t point, kernels::Vector n,
                          double lean, At&& at) {
  const kernels::Vector x = at(surface.first_point + point);
  for (const std::uint32_t other : surface.triangles->neighbours[point]) {
    const kernels::Vector d = at(surface.first_point + other) - x;
    if (dot(n, d) > lean * length(d)) return true;
  }
  return false;
}

/// Whether a triangle is a ghost at its nearest point; n leads from it to the other feature.
template <class At>
bool triangle_is_ghost(const ContactSurface& surface, std::uint32_t triangle,
                       const reference::Nearest& nearest, kernels::Vector n, double lean, At&& at) {
  const TriangleSurface::Triangle& t = surface.triangles->triangles[triangle];
  const TriangleSurface::Triangle& edges = surface.triangles->edges_of[triangle];
  const auto corner = [&](std::size_t k) {
    return neighbour_stands_out(surface, t[k], n, lean, at);
  };
  const auto edge = [&](std::size_t k) {
    return stands_out(surface, edges[k], at(surface.first_point + t[k]), n, lean, at);
  };
  switch (corners_of(nearest)) {
    case 1:
      return corner(0);
    case 2:
      return corner(1);
    case 4:
      return corner(2);
    case 3:
      return edge(0);
    case 6:
      return edge(1);
    case 5:
      return edge(2);
    default:
      return false;
  }
}

}  // namespace ghosts

template <class At>
bool is_ghost(std::span<const ContactSurface> surfaces, const Pair& pair, const FourPoints& x,
              const reference::Nearest& nearest, kernels::Vector n, double lean, At&& at) {
  const ContactSurface &first = surfaces[pair.a], &second = surfaces[pair.b];
  if (pair.kind == PairKind::point_triangle)
    return ghosts::triangle_is_ghost(second, pair.second, nearest, n, lean, at);
  const kernels::Vector on_first = x[0] + nearest.weight[1] * (x[1] - x[0]);
  const kernels::Vector on_second = x[2] - nearest.weight[3] * (x[3] - x[2]);
  return ghosts::stands_out(second, pair.second, on_second, n, lean, at) ||
         ghosts::stands_out(first, pair.first, on_first, -1.0 * n, lean, at);
}

}  // namespace weft
