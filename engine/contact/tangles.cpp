#include "engine/contact/tangles.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/contact/leads_through.h"
#include "engine/contact/look.h"
#include "engine/erase_repeated.h"
#include "kernels/reference/distances.h"

namespace weft {

using kernels::Vector;

namespace {

Box box_of(const ContactPoints& points, const Corners& corners) {
  Box box = Box::none();
  for (const Vector corner : corners) {
    const Vector from = corner - points.origin();
    const std::array<float, 3> place{static_cast<float>(from.x), static_cast<float>(from.y),
                                     static_cast<float>(from.z)};
    box.add({place, place});
  }
  return box;
}

bool edges_lead_through(const Corners& edges, const Corners& triangle) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (leads_through(edges[k], edges[(k + 1) % 3], triangle)) return true;
  }
  return false;
}

/// As the tree has it, when the interval begins.
Vector in_tree(const ContactPoints& points, const ContactSurface& surface, std::uint32_t slot) {
  const Vector x = points.start(slot);
  return surface.is_rigid ? surface.begins.from_place(x) : x - points.origin();
}
bool may_be_inside(const ContactPoints& points, std::uint32_t slot, const ContactSurface& surface) {
  const Vector x = in_tree(points, surface, slot);
  const std::array<float, 3> at{static_cast<float>(x.x), static_cast<float>(x.y),
                                static_cast<float>(x.z)};
  return surface.tree().box().meets({at, at});
}

/// The triangle of a surface that is nearest to a particle when the interval begins.
struct NearestTriangle {
  Pair pair{};
  std::array<std::uint32_t, 4> points{};
  reference::Nearest nearest{};
  bool is_there = false;
};

NearestTriangle find_nearest(ContactPoints& points, std::uint32_t slot, SurfacePair pair) {
  const ContactSurface& surface = points.surfaces()[pair.b];
  const Vector x = points.start(slot);
  const Vector from = in_tree(points, surface, slot);
  double least = std::numeric_limits<double>::infinity();
  NearestTriangle found;
  surface.tree().near(
      {static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)},
      [&](std::uint32_t triangle) {
        points.activate(pair.b, triangle);
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
  crossing_.clear();
  leave_crossing_alone();
  cloth_ = &cloth;
  misplaced_ = misplaced;
  within_.begin(cloth, misplaced.tangled);
  const std::vector<std::uint32_t>& slots = misplaced_.crossing;
  if (slots.empty()) return;
  const auto is_one = [&](std::uint32_t slot) { return std::ranges::binary_search(slots, slot); };
  for (std::uint32_t t = 0; t < cloth.triangles.size(); ++t) {
    if (!cloth.is_point(t) && std::ranges::all_of(cloth.triangles[t], is_one))
      crossing_.push_back(t);
  }
  leave_crossing_alone();
}

void Tangles::begin_interval() {
  leave_crossing_alone();
  within_.begin_interval();
}

void Tangles::find(ContactPoints& points) {
  misplaced_.inside.clear();
  for (std::uint32_t slot = 0; slot < points.slots(); ++slot) {
    if (points.inverse_mass(slot) == 0) continue;
    const bool is_inside = std::ranges::any_of(points.surface_pairs(), [&](SurfacePair pair) {
      const ContactSurface& surface = points.surfaces()[pair.b];
      return may_be_inside(points, slot, surface) && find_left_by(points, slot, pair).is_there;
    });
    if (is_inside) misplaced_.inside.push_back(slot);
  }
  find_crossing(points, [&](std::uint32_t point) { return points.start(point); });
  leave_crossing_alone();
}

void Tangles::find_within(const ContactPoints& points) {
  if (!points.touches_itself()) return;
  within_.find_at_start(points);
  misplaced_.tangled = within_.crossing();
}

void Tangles::find_crossing_within_at_end(const ContactPoints& points, bool has_failed) {
  within_.find_at_end(points, has_failed);
  misplaced_.tangled = within_.crossing();
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
      near[list_of(left_by.pair)].add(left_by.pair, left_by.points, -1.0 * n,
                                      points.thickness_of(left_by.pair), true);
    }
    return is_out;
  });
  for (const std::uint32_t t : triangles_) come_off(points, t, near);
}

/// A feature through a triangle whose particles are all out is a corner or an edge of a one-sided
/// body: it shows the way by its normal. Between two bodies it would lead into the other one.
void Tangles::come_off(ContactPoints& points, std::uint32_t triangle, Near& near) const {
  const TriangleSurface::Triangle& t = cloth_->triangles[triangle];
  if (is_inside(t[0]) || is_inside(t[1]) || is_inside(t[2])) return;
  const Corners corners{points.start(t[0]), points.start(t[1]), points.start(t[2])};
  const Box box = box_of(points, corners);
  const auto bodies = std::ranges::count_if(points.surface_pairs(), [&](SurfacePair pair) {
    const ContactSurface& body = points.surfaces()[pair.b];
    bool is_near = false;
    body.tree().find(table_, body.as_in_tree(box), [&](std::uint32_t) { is_near = true; });
    return is_near;
  });
  if (bodies > 1) return;
  for (const SurfacePair pair : points.surface_pairs()) {
    ContactSurface& body = points.surfaces()[pair.b];
    if (body.two_sided) continue;
    body.tree().find(table_, body.as_in_tree(box), [&](std::uint32_t other) {
      points.activate(pair.b, other);
      const TriangleSurface::Triangle its = body.points_of(other);
      const Corners there{points.start(its[0]), points.start(its[1]), points.start(its[2])};
      if (are_beside(corners, there) || are_beside(there, corners)) return;
      for (std::size_t k = 0; k < 3; ++k) {
        if (leads_through(there[k], there[(k + 1) % 3], corners))
          come_off_corner(points, pair, triangle, {its[k], its[(k + 1) % 3]}, near);
        if (leads_through(corners[k], corners[(k + 1) % 3], there))
          come_off_edges(points, pair, cloth_->edges_of[triangle][k], other, near);
      }
    });
  }
}

/// The end of the edge that is nearer to the triangle, if its normal leads on through that.
void Tangles::come_off_corner(ContactPoints& points, SurfacePair pair, std::uint32_t triangle,
                              std::array<std::uint32_t, 2> edge, Near& near) {
  ContactSurface& body = points.surfaces()[pair.b];
  const TriangleSurface::Triangle t = points.surfaces()[pair.a].points_of(triangle);
  const auto from = [&](std::uint32_t point) {
    return reference::nearest_in_triangle(points.start(point), points.start(t[0]),
                                          points.start(t[1]), points.start(t[2]));
  };
  const Vector a = from(edge[0]).r, b = from(edge[1]).r;
  if (dot(b, b) < dot(a, a)) std::swap(edge[0], edge[1]);
  const Vector sum = body.normals.of_point(edge[0] - body.first_point);
  const Vector n = kernels::direction(sum, length(sum));
  if (!(dot(n, points.start(edge[0]) - points.start(edge[1])) > 0)) return;
  add_under(points,
            {edge[0] - body.first_point, triangle, pair.b, pair.a, PairKind::point_triangle},
            {edge[0], t[0], t[1], t[2]}, -1.0 * n, near);
}

/// The edges of the triangle that the edge of the cloth is under, beside them.
void Tangles::come_off_edges(ContactPoints& points, SurfacePair pair, std::uint32_t edge,
                             std::uint32_t triangle, Near& near) const {
  ContactSurface& body = points.surfaces()[pair.b];
  const auto [a, b] = cloth_->edges[edge];
  const TriangleSurface::Triangle t = body.points_of(triangle);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::array<std::uint32_t, 4> four{a, b, t[k], t[(k + 1) % 3]};
    const FourPoints x = points.starts_of(four);
    const reference::Nearest found = reference::nearest_of_edges(x[0], x[1], x[2], x[3]);
    const Vector sum = body.normals.of_edge(triangle, k);
    if (!is_within_edges(found) || !(dot(found.r, sum) < 0)) continue;
    add_under(points,
              {edge, body.triangles->edges_of[triangle][k], pair.a, pair.b, PairKind::edges}, four,
              kernels::direction(sum, length(sum)), near);
  }
}

/// Each pair once.
void Tangles::add_under(const ContactPoints& points, const Pair& pair,
                        const std::array<std::uint32_t, 4>& four, Vector normal, Near& near) {
  NearPairs& pairs = near[list_of(pair)];
  if (pairs.find(pair) == pairs.list.size())
    pairs.add(pair, four, normal, points.thickness_of(pair), true);
}

/// The particle is inside from now on.
void Tangles::take_in(const ContactPoints& points, const Pair& pair) {
  if (pair.kind != PairKind::point_triangle || pair.is_turned() || points.later(pair).two_sided)
    return;
  std::vector<std::uint32_t>& inside = misplaced_.inside;
  if (!is_inside(pair.first))
    inside.insert(std::ranges::lower_bound(inside, pair.first), pair.first);
}

void Tangles::let_in(const ContactPoints& points, const Pair& pair) {
  take_in(points, pair);
  if (pair.kind == PairKind::point_triangle) {
    if (pair.is_turned()) leave_alone(pair.second);
    return;
  }
  const auto [a, b] = cloth_->edges[pair.first];
  for (const std::uint32_t t : cloth_->triangles_at[a]) {
    if (std::ranges::find(cloth_->triangles[t], b) != cloth_->triangles[t].end()) leave_alone(t);
  }
}

bool Tangles::any_is_inside(const std::array<std::uint32_t, 4>& points) const {
  return std::ranges::any_of(points, [&](std::uint32_t point) { return is_inside(point); });
}

void Tangles::leave_crossing_alone() {
  for (const std::uint32_t t : triangles_) {
    has_triangle_[t] = false;
    for (const std::uint32_t edge : cloth_->edges_of[t]) has_edge_[edge] = false;
  }
  triangles_.clear();
  for (const std::uint32_t t : crossing_) leave_alone(t);
}

void Tangles::leave_alone(std::uint32_t triangle) {
  has_triangle_.resize(cloth_->triangles.size());
  has_edge_.resize(cloth_->edges.size());
  if (has_triangle_[triangle]) return;
  has_triangle_[triangle] = true;
  for (const std::uint32_t edge : cloth_->edges_of[triangle]) has_edge_[edge] = true;
  triangles_.push_back(triangle);
}

void Tangles::gather_slots() {
  std::vector<std::uint32_t>& slots = misplaced_.crossing;
  slots.clear();
  for (const std::uint32_t t : crossing_)
    slots.insert(slots.end(), cloth_->triangles[t].begin(), cloth_->triangles[t].end());
  std::ranges::sort(slots);
  erase_repeated(slots);
}

template <class At>
bool Tangles::crosses(ContactPoints& points, std::uint32_t triangle, At&& at) const {
  const auto [a, b, c] = cloth_->triangles[triangle];
  const Corners corners{at(a), at(b), at(c)};
  const Box box = box_of(points, corners);
  bool does = false;
  for (const SurfacePair pair : points.surface_pairs()) {
    const ContactSurface& surface = points.surfaces()[pair.b];
    if (does || surface.may_cross[triangle] == 0) continue;
    surface.tree().find(table_, surface.as_in_tree(box), [&](std::uint32_t other) {
      if (does) return;
      points.activate(pair.b, other);
      const auto [p, q, r] = surface.points_of(other);
      const Corners its{at(p), at(q), at(r)};
      if (are_beside(corners, its) || are_beside(its, corners)) return;
      does = edges_lead_through(corners, its) || edges_lead_through(its, corners);
    });
  }
  return does;
}

template <class At>
void Tangles::find_crossing(ContactPoints& points, At&& at) {
  crossing_.clear();
  for (std::uint32_t t = 0; t < cloth_->triangles.size(); ++t) {
    if (!cloth_->is_point(t) && crosses(points, t, at)) crossing_.push_back(t);
  }
  gather_slots();
}

void Tangles::find_crossing_at_end(ContactPoints& points) {
  find_crossing(points, [&](std::uint32_t point) { return points.end(point); });
}

std::size_t Tangles::bytes() const {
  return misplaced_.bytes() + within_.bytes() + bytes_of(crossing_) + bytes_of(triangles_) +
         (has_triangle_.capacity() + has_edge_.capacity()) / 8;
}

}  // namespace weft
