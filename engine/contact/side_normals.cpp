#include "engine/contact/side_normals.h"

#include <weft/scene.h>

#include <algorithm>
#include <cmath>

#include "engine/bytes_of.h"

namespace weft {

using kernels::Vector;

void SideNormals::begin(const TriangleSurface& surface, const Vector* places, bool are_same) {
  if (!are_same || surface_ != &surface) ++interval_;
  surface_ = &surface;
  places_ = places;
  triangles_.make_room(surface.triangles.size());
  edges_.make_room(surface.edges.size());
  points_.make_room(surface.triangles_at.size());
}

template <class Compute>
Vector SideNormals::known(SparseArray<Known>& normals, std::uint32_t i, Compute&& compute) {
  if (normals[i].interval != interval_) normals[i] = {compute(), interval_};
  return normals[i].normal;
}

Vector SideNormals::of_triangle(std::uint32_t triangle) {
  return known(triangles_, triangle, [&] {
    const auto [a, b, c] = surface_->triangles[triangle];
    const Vector n = cross(places_[b] - places_[a], places_[c] - places_[a]);
    const double l = length(n);
    return l > 0 ? (1 / l) * n : Vector{};
  });
}

Vector SideNormals::of_edge(std::uint32_t edge) {
  return known(edges_, edge, [&] {
    Vector sum{};
    if (surface_->opposite[edge][1] == kNoIndex) return sum;
    const auto [a, b] = surface_->edges[edge];
    for (const std::uint32_t t : surface_->triangles_at[a]) {
      const TriangleSurface::Triangle& corners = surface_->triangles[t];
      if (std::ranges::find(corners, b) != corners.end()) sum = sum + of_triangle(t);
    }
    return sum;
  });
}

Vector SideNormals::of_edge(std::uint32_t triangle, std::size_t k) {
  return of_edge(surface_->edges_of[triangle][k]);
}

Vector SideNormals::of_point(std::uint32_t point) {
  return known(points_, point, [&] {
    Vector sum{};
    if (surface_->is_on_border(point)) return sum;
    const Vector x = places_[point];
    for (const std::uint32_t t : surface_->triangles_at[point]) {
      const TriangleSurface::Triangle& corners = surface_->triangles[t];
      const auto k = static_cast<std::size_t>(std::ranges::find(corners, point) - corners.begin());
      const Vector u = places_[corners[(k + 1) % 3]] - x, v = places_[corners[(k + 2) % 3]] - x;
      sum = sum + std::atan2(length(cross(u, v)), dot(u, v)) * of_triangle(t);
    }
    return sum;
  });
}

std::size_t SideNormals::bytes() const {
  return bytes_of(triangles_) + bytes_of(edges_) + bytes_of(points_);
}

}  // namespace weft
