#include "engine/contact/candidates.h"

#include <cmath>

namespace weft {
namespace {

using PointBoxes = std::array<Box, 3>;

/// What a box reaches along a direction.
struct Extent {
  float low = 0, high = 0;

  void add(const Extent& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
  bool meets(const Extent& other) const { return low <= other.high && high >= other.low; }
};
using PointExtents = std::array<Extent, 3>;

Extent sum(const PointExtents& extents) {
  Extent all = extents[0];
  all.add(extents[1]);
  all.add(extents[2]);
  return all;
}

/// Of a box along n, which may have any length, and what rounding adds.
Extent extent_along(const std::array<float, 3>& n, const Box& box) {
  float middle = 0, half = 0, size = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const float m = 0.5f * (box.low[k] + box.high[k]), h = box.high[k] - m, by = std::abs(n[k]);
    middle += n[k] * m;
    half += by * h;
    size += by * (std::abs(m) + h);
  }
  half += 0x1p-20f * size;
  return {middle - half, middle + half};
}

PointExtents extents_along(const std::array<float, 3>& n, const PointBoxes& boxes) {
  return {extent_along(n, boxes[0]), extent_along(n, boxes[1]), extent_along(n, boxes[2])};
}

Box sum(const PointBoxes& boxes) {
  Box all = boxes[0];
  all.add(boxes[1]);
  all.add(boxes[2]);
  return all;
}

/// Adds the pairs of features that a triangle of one surface and one of another
/// own. Their boxes meet, and what they reach along the normal of the first
/// triangle does: big boxes of slanted triangles hold dozens of small ones that
/// lie beside them.
class OwnedFeatures {
 public:
  OwnedFeatures(const ContactPoints& points, SurfacePair surfaces, Candidates& candidates)
      : points_(points),
        surfaces_(surfaces),
        a_(points.surfaces()[surfaces.a]),
        b_(points.surfaces()[surfaces.b]),
        candidates_(candidates) {}

  /// The triangle of the first surface that others are beside from now on.
  void begin(std::uint32_t a) { begin(a, boxes_of(a_.points_of(a))); }
  /// boxes: of its corners.
  void begin(std::uint32_t a, const PointBoxes& boxes) {
    triangle_ = a;
    corners_ = a_.points_of(a);
    boxes_a_ = boxes;
    whole_a_ = sum(boxes);
    const kernels::Vector x = points_.start(corners_[0]);
    const kernels::Vector n = cross(points_.start(corners_[1]) - x, points_.start(corners_[2]) - x);
    const double l = length(n), scale = l > 0 ? 1 / l : 0;
    normal_ = {static_cast<float>(scale * n.x), static_cast<float>(scale * n.y),
               static_cast<float>(scale * n.z)};
    extents_a_ = extents_along(normal_, boxes);
    extent_a_ = sum(extents_a_);
  }
  std::uint32_t triangle() const { return triangle_; }

  void add(std::uint32_t b) {
    const TriangleSurface::Triangle tb = b_.points_of(b);
    boxes_b_ = boxes_of(tb);
    extents_b_ = extents_along(normal_, boxes_b_);
    const Extent extent_b = sum(extents_b_);
    if (!extent_a_.meets(extent_b)) return;
    const Box whole_b = sum(boxes_b_);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!a_.triangles->owns_corner(triangle_, k) || !boxes_a_[k].meets(whole_b) ||
          !extents_a_[k].meets(extent_b))
        continue;
      add_pair(
          {corners_[k] - a_.first_point, b, surfaces_.a, surfaces_.b, PairKind::point_triangle},
          {corners_[k], tb[0], tb[1], tb[2]});
    }
    if (a_.triangles->is_point(triangle_)) return;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!b_.triangles->owns_corner(b, k) || !boxes_b_[k].meets(whole_a_) ||
          !extents_b_[k].meets(extent_a_))
        continue;
      add_pair(
          {tb[k] - b_.first_point, triangle_, surfaces_.b, surfaces_.a, PairKind::point_triangle},
          {tb[k], corners_[0], corners_[1], corners_[2]});
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (!a_.triangles->owns_edge(triangle_, i)) continue;
      const std::size_t next = (i + 1) % 3;
      Box edge = boxes_a_[i];
      edge.add(boxes_a_[next]);
      Extent extent = extents_a_[i];
      extent.add(extents_a_[next]);
      if (edge.meets(whole_b) && extent.meets(extent_b)) add_edges(i, b, edge, extent);
    }
  }

 private:
  PointBoxes boxes_of(const TriangleSurface::Triangle& t) const {
    return {points_.wide_box(t[0]), points_.wide_box(t[1]), points_.wide_box(t[2])};
  }
  /// edge, extent: of the edge i of the first triangle.
  void add_edges(std::size_t i, std::uint32_t b, const Box& edge, const Extent& extent) {
    const TriangleSurface::Triangle tb = b_.points_of(b);
    for (std::size_t j = 0; j < 3; ++j) {
      if (!b_.triangles->owns_edge(b, j)) continue;
      const std::size_t next = (j + 1) % 3;
      Box other = boxes_b_[j];
      other.add(boxes_b_[next]);
      Extent reaches = extents_b_[j];
      reaches.add(extents_b_[next]);
      if (!edge.meets(other) || !extent.meets(reaches)) continue;
      add_pair({a_.triangles->edges_of[triangle_][i], b_.triangles->edges_of[b][j], surfaces_.a,
                surfaces_.b, PairKind::edges},
               {corners_[i], corners_[(i + 1) % 3], tb[j], tb[next]});
    }
  }
  void add_pair(const Pair& pair, const std::array<std::uint32_t, 4>& points) {
    candidates_[list_of(pair.kind)].add(pair, points);
  }

  const ContactPoints& points_;
  const SurfacePair surfaces_;
  const ContactSurface &a_, &b_;
  Candidates& candidates_;
  std::uint32_t triangle_ = kNoIndex;
  TriangleSurface::Triangle corners_{};
  std::array<float, 3> normal_{};
  PointBoxes boxes_a_{}, boxes_b_{};
  PointExtents extents_a_{}, extents_b_{};
  Box whole_a_{};
  Extent extent_a_{};
};

}  // namespace

/// Whether wide boxes hold, or may be renewed without a new candidate: cloth
/// that flutters far from all others asks for none.
bool CandidateSearch::still_holds(ContactPoints& points) {
  has_moved_.assign(points.slots(), 0);
  bool any = false;
  const bool bodies_hold = points.widen_boxes_of_cloth([&](std::uint32_t slot) {
    has_moved_[slot] = 1;
    any = true;
  });
  if (!bodies_hold) return false;
  if (!any) return true;
  for (const TriangleSurface::Triangle& t : points.cloth().triangles) {
    if ((has_moved_[t[0]] | has_moved_[t[1]] | has_moved_[t[2]]) == 0) continue;
    const Box box = points.wide_box(t);
    bool is_near = false;
    for (const SurfacePair pair : points.surface_pairs())
      points.surfaces()[pair.b].tree.find(table_, box, [&](std::uint32_t) { is_near = true; });
    if (is_near) return false;
  }
  return true;
}

void CandidateSearch::find(ContactPoints& points, Candidates& candidates) {
  if (points.has_wide_boxes() && still_holds(points)) return;
  points.widen_boxes();
  for (ContactSurface& surface : points.surfaces())
    surface.tree.refit([&](std::uint32_t t) { return points.wide_box(surface.points_of(t)); });
  for (PairList& list : candidates) list.clear();
  for (const SurfacePair pair : points.surface_pairs()) {
    OwnedFeatures features(points, pair, candidates);
    BoxTree::meet(table_, points.surfaces()[pair.a].tree, points.surfaces()[pair.b].tree,
                  [&](std::uint32_t a, std::uint32_t b) {
                    if (features.triangle() != a) features.begin(a);
                    features.add(b);
                  });
  }
}

void CandidateSearch::find_beside(const ContactPoints& points, std::uint32_t triangle,
                                  const Box& box, Candidates& candidates) const {
  for (const SurfacePair pair : points.surface_pairs()) {
    OwnedFeatures features(points, pair, candidates);
    features.begin(triangle, {box, box, box});
    points.surfaces()[pair.b].tree.find(table_, box,
                                        [&](std::uint32_t other) { features.add(other); });
  }
}

}  // namespace weft
