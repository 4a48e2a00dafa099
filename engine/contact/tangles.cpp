#include "engine/contact/tangles.h"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/contact/look.h"

namespace weft {

using kernels::Vector;

namespace {

using Corners = std::array<Vector, 3>;

/// Six times the volume of the tetrahedron; its sign tells on which side of a b c d is.
double volume(Vector a, Vector b, Vector c, Vector d) { return dot(cross(a - d, b - d), c - d); }

/// What only touches the triangle does not lead through it.
bool leads_through(Vector from, Vector to, const Corners& t) {
  const double side = volume(t[0], t[1], t[2], from), other = volume(t[0], t[1], t[2], to);
  const double touches = kTouching * length(cross(t[1] - t[0], t[2] - t[0]));
  if (std::min(side, other) >= -touches || std::max(side, other) <= touches) return false;
  const double turns[] = {volume(from, to, t[0], t[1]), volume(from, to, t[1], t[2]),
                          volume(from, to, t[2], t[0])};
  const auto [least, most] = std::ranges::minmax(turns);
  return least >= 0 || most <= 0;
}

bool edges_lead_through(const Corners& edges, const Corners& triangle) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (leads_through(edges[k], edges[(k + 1) % 3], triangle)) return true;
  }
  return false;
}

}  // namespace

void Tangles::begin(const TriangleSurface& cloth, std::span<const std::uint32_t> slots) {
  forget();
  cloth_ = &cloth;
  slots_.assign(slots.begin(), slots.end());
  if (slots_.empty()) return;
  const auto is_one = [&](std::uint32_t slot) { return std::ranges::binary_search(slots_, slot); };
  for (std::uint32_t t = 0; t < cloth.triangles.size(); ++t) {
    if (!cloth.is_point(t) && std::ranges::all_of(cloth.triangles[t], is_one)) add(t);
  }
}

void Tangles::forget() {
  for (const std::uint32_t t : triangles_) {
    has_triangle_[t] = false;
    for (const std::uint32_t edge : cloth_->edges_of[t]) has_edge_[edge] = false;
  }
  triangles_.clear();
}

void Tangles::add(std::uint32_t triangle) {
  has_triangle_.resize(cloth_->triangles.size());
  has_edge_.resize(cloth_->edges.size());
  has_triangle_[triangle] = true;
  for (const std::uint32_t edge : cloth_->edges_of[triangle]) has_edge_[edge] = true;
  triangles_.push_back(triangle);
}

void Tangles::gather_slots() {
  slots_.clear();
  for (const std::uint32_t t : triangles_)
    slots_.insert(slots_.end(), cloth_->triangles[t].begin(), cloth_->triangles[t].end());
  std::ranges::sort(slots_);
  const auto rest = std::ranges::unique(slots_);
  slots_.erase(rest.begin(), rest.end());
}

template <class At>
bool Tangles::crosses(const ContactPoints& points, std::uint32_t triangle, At&& at) const {
  const auto [a, b, c] = cloth_->triangles[triangle];
  const Corners corners{at(a), at(b), at(c)};
  Box box = Box::none();
  for (const Vector corner : corners) {
    const Vector from = corner - points.origin();
    const std::array<float, 3> place{static_cast<float>(from.x), static_cast<float>(from.y),
                                     static_cast<float>(from.z)};
    box.add({place, place});
  }
  bool does = false;
  for (const ContactMesh& mesh : points.meshes()) {
    mesh.tree.find(table_, box, [&](std::uint32_t other) {
      if (does) return;
      const auto [p, q, r] = mesh.mesh().surface.triangles[other];
      const std::uint32_t first = mesh.first_point;
      const Corners its{at(first + p), at(first + q), at(first + r)};
      does = edges_lead_through(corners, its) || edges_lead_through(its, corners);
    });
  }
  return does;
}

void Tangles::find(const ContactPoints& points, Moment moment) {
  forget();
  const bool begins = moment == Moment::start;
  const auto at = [&](std::uint32_t p) { return begins ? points.start(p) : points.end(p); };
  for (std::uint32_t t = 0; t < cloth_->triangles.size(); ++t) {
    if (!cloth_->is_point(t) && crosses(points, t, at)) add(t);
  }
  gather_slots();
}

std::size_t Tangles::bytes() const {
  return bytes_of(triangles_) + bytes_of(slots_) +
         (has_triangle_.capacity() + has_edge_.capacity()) / 8;
}

}  // namespace weft
