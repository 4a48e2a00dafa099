#include "engine/contact/candidates.h"

namespace weft {
namespace {

using PointBoxes = std::array<Box, 3>;

Box sum(const PointBoxes& boxes) {
  Box all = boxes[0];
  all.add(boxes[1]);
  all.add(boxes[2]);
  return all;
}

/// Adds the pairs of features that a triangle of one surface and one of another own.
class OwnedFeatures {
 public:
  OwnedFeatures(const ContactPoints& points, SurfacePair surfaces, Candidates& candidates)
      : points_(points),
        surfaces_(surfaces),
        a_(points.surfaces()[surfaces.a]),
        b_(points.surfaces()[surfaces.b]),
        candidates_(candidates) {}

  void add(std::uint32_t a, std::uint32_t b) { add(a, b, boxes_of(a_.points_of(a))); }
  /// of_a: the boxes of the corners of a.
  void add(std::uint32_t a, std::uint32_t b, const PointBoxes& of_a) {
    const TriangleSurface::Triangle ta = a_.points_of(a), tb = b_.points_of(b);
    const PointBoxes of_b = boxes_of(tb);
    const Box whole_a = sum(of_a), whole_b = sum(of_b);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!a_.triangles->owns_corner(a, k) || !of_a[k].meets(whole_b)) continue;
      add_pair({ta[k] - a_.first_point, b, surfaces_.a, surfaces_.b, PairKind::point_triangle},
               {ta[k], tb[0], tb[1], tb[2]});
    }
    if (a_.triangles->is_point(a)) return;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!b_.triangles->owns_corner(b, k) || !of_b[k].meets(whole_a)) continue;
      add_pair({tb[k] - b_.first_point, a, surfaces_.b, surfaces_.a, PairKind::point_triangle},
               {tb[k], ta[0], ta[1], ta[2]});
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (!a_.triangles->owns_edge(a, i)) continue;
      const std::size_t next = (i + 1) % 3;
      Box edge = of_a[i];
      edge.add(of_a[next]);
      if (edge.meets(whole_b)) add_edges(a, i, b, edge, of_b);
    }
  }

 private:
  PointBoxes boxes_of(const TriangleSurface::Triangle& t) const {
    return {points_.wide_box(t[0]), points_.wide_box(t[1]), points_.wide_box(t[2])};
  }
  /// edge: the box of the edge i of a.
  void add_edges(std::uint32_t a, std::size_t i, std::uint32_t b, const Box& edge,
                 const PointBoxes& of_b) {
    const TriangleSurface::Triangle ta = a_.points_of(a), tb = b_.points_of(b);
    for (std::size_t j = 0; j < 3; ++j) {
      if (!b_.triangles->owns_edge(b, j)) continue;
      const std::size_t next = (j + 1) % 3;
      Box other = of_b[j];
      other.add(of_b[next]);
      if (!edge.meets(other)) continue;
      add_pair({a_.triangles->edges_of[a][i], b_.triangles->edges_of[b][j], surfaces_.a,
                surfaces_.b, PairKind::edges},
               {ta[i], ta[(i + 1) % 3], tb[j], tb[next]});
    }
  }
  void add_pair(const Pair& pair, const std::array<std::uint32_t, 4>& points) {
    candidates_[list_of(pair.kind)].add(pair, points);
  }

  const ContactPoints& points_;
  const SurfacePair surfaces_;
  const ContactSurface &a_, &b_;
  Candidates& candidates_;
};

}  // namespace

/// Whether wide boxes hold, or may be renewed without a new candidate: cloth that flutters far from
/// all others asks for none.
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
                  [&](std::uint32_t a, std::uint32_t b) { features.add(a, b); });
  }
}

void CandidateSearch::find_beside(const ContactPoints& points, std::uint32_t triangle,
                                  const Box& box, Candidates& candidates) const {
  for (const SurfacePair pair : points.surface_pairs()) {
    OwnedFeatures features(points, pair, candidates);
    points.surfaces()[pair.b].tree.find(table_, box, [&](std::uint32_t other) {
      features.add(triangle, other, {box, box, box});
    });
  }
}

}  // namespace weft
