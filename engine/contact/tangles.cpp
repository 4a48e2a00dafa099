#include "engine/contact/tangles.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/contact/look.h"
#include "kernels/reference/distances.h"

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

/// The triangle of a surface that is nearest to a particle when the interval begins.
struct NearestTriangle {
  Pair pair{};
  std::array<std::uint32_t, 4> points{};
  reference::Nearest nearest{};
  bool is_there = false;
};

NearestTriangle find_nearest(const ContactPoints& points, std::uint32_t slot, SurfacePair pair) {
  const ContactSurface& surface = points.surfaces()[pair.b];
  const Vector x = points.start(slot), from = x - points.origin();
  double least = std::numeric_limits<double>::infinity();
  NearestTriangle found;
  surface.tree.near(
      {static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)},
      [&](std::uint32_t triangle) {
        const auto [a, b, c] = surface.points_of(triangle);
        const reference::Nearest other =
            reference::nearest_in_triangle(x, points.start(a), points.start(b), points.start(c));
        const double square = dot(other.r, other.r);
        if (square < least) {
          least = square;
          found = {.pair = {slot, triangle, pair.a, pair.b, PairKind::point_triangle},
                   .points = {slot, a, b, c},
                   .nearest = other,
                   .is_there = true};
        }
        return static_cast<float>(least);
      });
  return found;
}

/// The triangle of a one-sided surface that a particle is behind, if it is.
NearestTriangle find_left_by(ContactPoints& points, std::uint32_t slot, SurfacePair pair) {
  ContactSurface& surface = points.surfaces()[pair.b];
  if (surface.two_sided) return {};
  NearestTriangle found = find_nearest(points, slot, pair);
  found.is_there = found.is_there && is_behind(surface, found.pair, found.nearest);
  return found;
}

}  // namespace

void Tangles::begin(const TriangleSurface& cloth, const Misplaced& misplaced) {
  forget_crossing();
  cloth_ = &cloth;
  misplaced_ = misplaced;
  const std::vector<std::uint32_t>& slots = misplaced_.crossing;
  if (slots.empty()) return;
  const auto is_one = [&](std::uint32_t slot) { return std::ranges::binary_search(slots, slot); };
  for (std::uint32_t t = 0; t < cloth.triangles.size(); ++t) {
    if (!cloth.is_point(t) && std::ranges::all_of(cloth.triangles[t], is_one)) add_crossing(t);
  }
}

void Tangles::find(ContactPoints& points) {
  misplaced_.inside.clear();
  for (std::uint32_t slot = 0; slot < points.slots(); ++slot) {
    if (points.inverse_mass(slot) == 0) continue;
    const bool is_inside = std::ranges::any_of(points.surface_pairs(), [&](SurfacePair pair) {
      const BoxTree& tree = points.surfaces()[pair.b].tree;
      return tree.box().meets(points.box(slot)) && find_left_by(points, slot, pair).is_there;
    });
    if (is_inside) misplaced_.inside.push_back(slot);
  }
  find_crossing(points, [&](std::uint32_t point) { return points.start(point); });
}

/// They are near to the surface that they leave by, however deep they are.
void Tangles::come_out(ContactPoints& points, Near& near) {
  std::erase_if(misplaced_.inside, [&](std::uint32_t slot) {
    bool is_out = true;
    for (const SurfacePair pair : points.surface_pairs()) {
      const NearestTriangle left_by = find_left_by(points, slot, pair);
      if (!left_by.is_there) continue;
      is_out = false;
      const Vector r = left_by.nearest.r, n = kernels::direction(r, length(r));
      near[list_of(left_by.pair.kind)].add(left_by.pair, left_by.points, -1.0 * n,
                                           points.later(left_by.pair).thickness, true);
    }
    return is_out;
  });
}

/// The particle is inside from now on.
void Tangles::take_in(const ContactPoints& points, const Pair& pair) {
  if (pair.kind != PairKind::point_triangle || pair.is_turned() || points.later(pair).two_sided)
    return;
  std::vector<std::uint32_t>& inside = misplaced_.inside;
  if (!is_inside(pair.first))
    inside.insert(std::ranges::lower_bound(inside, pair.first), pair.first);
}

bool Tangles::is_inside(const std::array<std::uint32_t, 4>& points) const {
  return std::ranges::any_of(points, [&](std::uint32_t point) { return is_inside(point); });
}

void Tangles::forget_crossing() {
  for (const std::uint32_t t : triangles_) {
    has_triangle_[t] = false;
    for (const std::uint32_t edge : cloth_->edges_of[t]) has_edge_[edge] = false;
  }
  triangles_.clear();
}

void Tangles::add_crossing(std::uint32_t triangle) {
  has_triangle_.resize(cloth_->triangles.size());
  has_edge_.resize(cloth_->edges.size());
  has_triangle_[triangle] = true;
  for (const std::uint32_t edge : cloth_->edges_of[triangle]) has_edge_[edge] = true;
  triangles_.push_back(triangle);
}

void Tangles::gather_slots() {
  std::vector<std::uint32_t>& slots = misplaced_.crossing;
  slots.clear();
  for (const std::uint32_t t : triangles_)
    slots.insert(slots.end(), cloth_->triangles[t].begin(), cloth_->triangles[t].end());
  std::ranges::sort(slots);
  const auto rest = std::ranges::unique(slots);
  slots.erase(rest.begin(), rest.end());
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
  for (const SurfacePair pair : points.surface_pairs()) {
    const ContactSurface& surface = points.surfaces()[pair.b];
    surface.tree.find(table_, box, [&](std::uint32_t other) {
      if (does) return;
      const auto [p, q, r] = surface.points_of(other);
      const Corners its{at(p), at(q), at(r)};
      does = edges_lead_through(corners, its) || edges_lead_through(its, corners);
    });
  }
  return does;
}

template <class At>
void Tangles::find_crossing(const ContactPoints& points, At&& at) {
  forget_crossing();
  for (std::uint32_t t = 0; t < cloth_->triangles.size(); ++t) {
    if (!cloth_->is_point(t) && crosses(points, t, at)) add_crossing(t);
  }
  gather_slots();
}

void Tangles::find_crossing_at_end(const ContactPoints& points) {
  find_crossing(points, [&](std::uint32_t point) { return points.end(point); });
}

std::size_t Tangles::bytes() const {
  return misplaced_.bytes() + bytes_of(triangles_) +
         (has_triangle_.capacity() + has_edge_.capacity()) / 8;
}

}  // namespace weft
