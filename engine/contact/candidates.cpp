#include "engine/contact/candidates.h"

namespace weft {
namespace {

/// Adds the pairs of features that two triangles own.
class Features {
 public:
  Features(const TriangleSurface& cloth, const ContactPoints& points, std::uint16_t mesh,
           Candidates& candidates)
      : cloth_(cloth),
        body_(points.meshes()[mesh].mesh().surface),
        points_(points),
        first_(points.meshes()[mesh].first_point),
        mesh_(mesh),
        candidates_(candidates) {}

  /// of_cloth(point): its box.
  template <class BoxOf>
  void add(std::uint32_t a, std::uint32_t b, BoxOf&& of_cloth) {
    const TriangleSurface::Triangle ta = cloth_.triangles[a], tb = on_body(body_.triangles[b]);
    const std::array<Box, 3> of_a{of_cloth(ta[0]), of_cloth(ta[1]), of_cloth(ta[2])};
    const std::array<Box, 3> of_b{points_.hull(tb[0]), points_.hull(tb[1]), points_.hull(tb[2])};
    const Box whole_a = sum(of_a), whole_b = sum(of_b);
    for (std::size_t k = 0; k < 3; ++k) {
      if (cloth_.owns_corner(a, k) && of_a[k].meets(whole_b))
        add_pair({ta[k], b, mesh_, PairKind::particle_triangle}, {ta[k], tb[0], tb[1], tb[2]});
    }
    if (cloth_.is_point(a)) return;
    for (std::size_t k = 0; k < 3; ++k) {
      if (body_.owns_corner(b, k) && of_b[k].meets(whole_a))
        add_pair({a, tb[k] - first_, mesh_, PairKind::vertex_triangle},
                 {tb[k], ta[0], ta[1], ta[2]});
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (!cloth_.owns_edge(a, i)) continue;
      const std::size_t next = (i + 1) % 3;
      Box edge = of_a[i];
      edge.add(of_a[next]);
      if (edge.meets(whole_b)) add_edges(a, i, b, edge, ta, tb, of_b);
    }
  }

 private:
  static Box sum(const std::array<Box, 3>& boxes) {
    Box all = boxes[0];
    all.add(boxes[1]);
    all.add(boxes[2]);
    return all;
  }
  TriangleSurface::Triangle on_body(const TriangleSurface::Triangle& t) const {
    return {first_ + t[0], first_ + t[1], first_ + t[2]};
  }
  void add_edges(std::uint32_t a, std::size_t i, std::uint32_t b, const Box& edge,
                 const TriangleSurface::Triangle& ta, const TriangleSurface::Triangle& tb,
                 const std::array<Box, 3>& of_b) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (!body_.owns_edge(b, j)) continue;
      const std::size_t next = (j + 1) % 3;
      Box other = of_b[j];
      other.add(of_b[next]);
      if (!edge.meets(other)) continue;
      add_pair({cloth_.edges_of[a][i], body_.edges_of[b][j], mesh_, PairKind::edges},
               {ta[i], ta[(i + 1) % 3], tb[j], tb[next]});
    }
  }
  void add_pair(const Pair& pair, const std::array<std::uint32_t, 4>& points) {
    candidates_[list_of(pair.kind)].add(pair, points);
  }

  const TriangleSurface& cloth_;
  const TriangleSurface& body_;
  const ContactPoints& points_;
  const std::uint32_t first_;
  const std::uint16_t mesh_;
  Candidates& candidates_;
};

}  // namespace

/// Whether hulls hold, or may be renewed without a new candidate: what flutters far from all bodies
/// asks for no others.
bool CandidateSearch::still_holds(const TriangleSurface& cloth, ContactPoints& points) {
  has_moved_.assign(points.slots(), 0);
  bool any = false;
  const bool bodies_hold = points.renew_hulls_of_cloth([&](std::uint32_t slot) {
    has_moved_[slot] = 1;
    any = true;
  });
  if (!bodies_hold) return false;
  if (!any) return true;
  for (const TriangleSurface::Triangle& t : cloth.triangles) {
    if ((has_moved_[t[0]] | has_moved_[t[1]] | has_moved_[t[2]]) == 0) continue;
    Box box = points.hull(t[0]);
    box.add(points.hull(t[1]));
    box.add(points.hull(t[2]));
    bool is_near = false;
    for (const ContactMesh& mesh : points.meshes())
      mesh.tree.find(table_, box, [&](std::uint32_t) { is_near = true; });
    if (is_near) return false;
  }
  return true;
}

void CandidateSearch::find(const TriangleSurface& cloth, ContactPoints& points,
                           Candidates& candidates) {
  if (points.has_hulls() && still_holds(cloth, points)) return;
  points.renew_hulls();
  if (!is_built_) tree_ = BoxTree(cloth.in_order);
  is_built_ = true;
  const auto box_of = [&](const TriangleSurface::Triangle& t, std::uint32_t first) {
    Box box = points.hull(first + t[0]);
    box.add(points.hull(first + t[1]));
    box.add(points.hull(first + t[2]));
    return box;
  };
  tree_.refit([&](std::uint32_t t) { return box_of(cloth.triangles[t], 0); });
  for (PairList& list : candidates) list.clear();
  for (std::uint16_t i = 0; i < points.meshes().size(); ++i) {
    ContactMesh& mesh = points.meshes()[i];
    const TriangleSurface& body = mesh.mesh().surface;
    mesh.tree.refit([&](std::uint32_t t) { return box_of(body.triangles[t], mesh.first_point); });
    Features features(cloth, points, i, candidates);
    BoxTree::meet(table_, tree_, mesh.tree, [&](std::uint32_t a, std::uint32_t b) {
      features.add(a, b, [&](std::uint32_t point) -> const Box& { return points.hull(point); });
    });
  }
}

void CandidateSearch::find_beside(const TriangleSurface& cloth, const ContactPoints& points,
                                  std::uint32_t triangle, const Box& box,
                                  Candidates& candidates) const {
  for (std::uint16_t i = 0; i < points.meshes().size(); ++i) {
    Features features(cloth, points, i, candidates);
    points.meshes()[i].tree.find(table_, box, [&](std::uint32_t other) {
      features.add(triangle, other, [&](std::uint32_t) -> const Box& { return box; });
    });
  }
}

}  // namespace weft
