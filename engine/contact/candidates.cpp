#include "engine/contact/candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/bytes_of.h"

namespace weft {
namespace {

/// Directions along which the boxes of triangles are to meet besides x, y and z: the normal of a
/// triangle of the cloth, and in its plane the three across its edges. By x, y and z alone big
/// boxes of slanted triangles and edges meet those of dozens that lie beside them. Lengths do not
/// matter.
struct TriangleAxes {
  alignas(16) float x[4]{}, y[4]{}, z[4]{};

  void set(std::size_t i, kernels::Vector v) {
    const double l = length(v), scale = l > 0 ? 1 / l : 0;
    x[i] = static_cast<float>(scale * v.x);
    y[i] = static_cast<float>(scale * v.y);
    z[i] = static_cast<float>(scale * v.z);
  }
};

/// What something reaches along x, y, z and an unused direction, and along the four axes: when
/// tubes begin, and when they end.
struct Reach {
  static constexpr std::size_t kAxes = 8;
  alignas(16) float low[2 * kAxes], high[2 * kAxes];

  void add(const Reach& other) {
    for (std::size_t k = 0; k < 2 * kAxes; ++k) {
      low[k] = std::min(low[k], other.low[k]);
      high[k] = std::max(high[k], other.high[k]);
    }
  }
  /// What is on one side of the other at both ends is there all of the way.
  bool meets(const Reach& other) const {
    int apart = 0;
    for (std::size_t k = 0; k < kAxes; ++k) {
      apart |= static_cast<int>(low[k] > other.high[k]) &
               static_cast<int>(low[kAxes + k] > other.high[kAxes + k]);
      apart |= static_cast<int>(high[k] < other.low[k]) &
               static_cast<int>(high[kAxes + k] < other.low[kAxes + k]);
    }
    return apart == 0;
  }
};
using CornerReaches = std::array<Reach, 3>;

Reach sum(const Reach& a, const Reach& b) {
  Reach all = a;
  all.add(b);
  return all;
}
Reach sum(const CornerReaches& reaches) { return sum(sum(reaches[0], reaches[1]), reaches[2]); }

struct Range {
  float low = 0, high = 0;
};
/// Of a box along one of the axes, and what rounding adds.
Range range_along(const TriangleAxes& axes, std::size_t i, const Box& box) {
  float middle = 0, wide = 0, size = 0;
  const float axis[] = {axes.x[i], axes.y[i], axes.z[i]};
  for (std::size_t k = 0; k < 3; ++k) {
    const float m = 0.5f * (box.low[k] + box.high[k]), half = box.high[k] - m;
    middle += axis[k] * m;
    wide += std::abs(axis[k]) * half;
    size += std::abs(m) + half;
  }
  wide += 0x1p-20f * size;
  return {middle - wide, middle + wide};
}
void write_reach(const TriangleAxes& axes, const Box& box, float* low, float* high) {
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = box.low[k];
    high[k] = box.high[k];
  }
  low[3] = high[3] = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Range range = range_along(axes, i, box);
    low[4 + i] = range.low;
    high[4 + i] = range.high;
  }
}
Reach reach_along(const TriangleAxes& axes, const Tube& tube) {
  Reach reach;
  write_reach(axes, tube.begins, reach.low, reach.high);
  write_reach(axes, tube.ends, reach.low + Reach::kAxes, reach.high + Reach::kAxes);
  return reach;
}

/// Adds the pairs of features that a triangle of one surface and one of another own.
class OwnedFeatures {
 public:
  OwnedFeatures(ContactPoints& points, SurfacePair surfaces, Candidates& candidates)
      : points_(points),
        surfaces_(surfaces),
        a_(points.surfaces()[surfaces.a]),
        b_(points.surfaces()[surfaces.b]),
        may_cross_(points.surfaces()[surfaces.b].may_cross),
        candidates_(candidates) {}

  /// The triangle of the first surface that others are beside from now on.
  void begin(std::uint32_t a) { begin(a, points_.tubes(a_.points_of(a))); }
  /// tubes: of its corners.
  void begin(std::uint32_t a, const std::array<Tube, 3>& tubes) {
    triangle_a_ = a;
    corners_a_ = a_.points_of(a);
    set_axes();
    for (std::size_t k = 0; k < 3; ++k) corner_a_[k] = reach_along(axes_, tubes[k]);
    for (std::size_t k = 0; k < 3; ++k) edge_a_[k] = sum(corner_a_[k], corner_a_[(k + 1) % 3]);
    whole_a_ = sum(corner_a_);
  }
  std::uint32_t triangle() const { return triangle_a_; }

  void add(std::uint32_t b) {
    triangle_b_ = b;
    corners_b_ = b_.points_of(b);
    if (is_beside()) return;
    for (std::size_t k = 0; k < 3; ++k)
      corner_b_[k] = reach_along(axes_, points_.tube(corners_b_[k]));
    const Reach whole_b = sum(corner_b_);
    if (!whole_a_.meets(whole_b)) return;
    may_cross_[triangle_a_] = 1;
    for (std::size_t k = 0; k < 3 && !b_.triangles->is_point(b); ++k) {
      if (!a_.triangles->owns_corner(triangle_a_, k) || !corner_a_[k].meets(whole_b)) continue;
      add_pair(
          {corners_a_[k] - a_.first_point, b, surfaces_.a, surfaces_.b, PairKind::point_triangle},
          {corners_a_[k], corners_b_[0], corners_b_[1], corners_b_[2]});
    }
    if (a_.triangles->is_point(triangle_a_)) return;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!b_.triangles->owns_corner(b, k) || !corner_b_[k].meets(whole_a_)) continue;
      add_pair({corners_b_[k] - b_.first_point, triangle_a_, surfaces_.b, surfaces_.a,
                PairKind::point_triangle},
               {corners_b_[k], corners_a_[0], corners_a_[1], corners_a_[2]});
    }
    for (std::size_t j = 0; j < 3; ++j) {
      if (b_.triangles->owns_edge(b, j)) add_edges(j);
    }
  }

 private:
  /// Whether all of the second triangle is on one side of the first, along its normal: most are.
  bool is_beside() const {
    const Tube* tubes[] = {&points_.tube(corners_b_[0]), &points_.tube(corners_b_[1]),
                           &points_.tube(corners_b_[2])};
    const auto reach = [&](Box Tube::*when) {
      float low = std::numeric_limits<float>::max(), high = -low;
      for (const Tube* tube : tubes) {
        const Range range = range_along(axes_, 0, tube->*when);
        low = std::min(low, range.low);
        high = std::max(high, range.high);
      }
      return Range{low, high};
    };
    constexpr std::size_t kNormal = 4, kEnd = Reach::kAxes + kNormal;
    const Range begins = reach(&Tube::begins), ends = reach(&Tube::ends);
    return (begins.low > whole_a_.high[kNormal] && ends.low > whole_a_.high[kEnd]) ||
           (begins.high < whole_a_.low[kNormal] && ends.high < whole_a_.low[kEnd]);
  }
  static bool share_a_point(PairKind kind, const std::array<std::uint32_t, 4>& points) {
    const auto [a, b, c, d] = points;
    const bool first = a == c || a == d;
    return first || (kind == PairKind::edges ? b == c || b == d : a == b);
  }
  /// In the plane of the triangle, where the interval begins.
  void set_axes() {
    const kernels::Vector x[] = {points_.start(corners_a_[0]), points_.start(corners_a_[1]),
                                 points_.start(corners_a_[2])};
    const kernels::Vector n = cross(x[1] - x[0], x[2] - x[0]);
    axes_.set(0, n);
    for (std::size_t k = 0; k < 3; ++k) axes_.set(1 + k, cross(n, x[(k + 1) % 3] - x[k]));
  }
  /// Of the first triangle with the edge j of the second.
  void add_edges(std::size_t j) {
    const std::size_t next = (j + 1) % 3;
    const Reach edge_b = sum(corner_b_[j], corner_b_[next]);
    for (std::size_t i = 0; i < 3; ++i) {
      if (!a_.triangles->owns_edge(triangle_a_, i) || !edge_a_[i].meets(edge_b)) continue;
      add_pair({a_.triangles->edges_of[triangle_a_][i], b_.triangles->edges_of[triangle_b_][j],
                surfaces_.a, surfaces_.b, PairKind::edges},
               {corners_a_[i], corners_a_[(i + 1) % 3], corners_b_[j], corners_b_[next]});
    }
  }
  void add_pair(const Pair& pair, const std::array<std::uint32_t, 4>& points) {
    if (pair.is_within_cloth() && share_a_point(pair.kind, points)) return;
    candidates_[list_of(pair.kind)].add(pair, points);
    if (pair.is_within_cloth()) return;
    if (std::exchange(active_, triangle_b_) != triangle_b_)
      points_.activate(surfaces_.b, triangle_b_);
  }

  ContactPoints& points_;
  const SurfacePair surfaces_;
  const ContactSurface &a_, &b_;
  std::vector<std::uint8_t>& may_cross_;
  Candidates& candidates_;
  std::uint32_t triangle_a_ = kNoIndex, triangle_b_ = kNoIndex, active_ = kNoIndex;
  TriangleSurface::Triangle corners_a_{}, corners_b_{};
  TriangleAxes axes_;
  CornerReaches corner_a_{}, edge_a_{}, corner_b_{};
  Reach whole_a_{};
};

}  // namespace

void CandidateSearch::find_all(ContactPoints& points, SurfacePair pair, Candidates& candidates) {
  ContactSurface& body = points.surfaces()[pair.b];
  const ContactSurface& cloth = points.surfaces()[pair.a];
  OwnedFeatures features(points, pair, candidates);
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    if (features.triangle() != a) features.begin(a);
    features.add(b);
  };
  if (!body.is_rigid) {
    body.tree.refit([&](std::uint32_t t) { return points.in_tree(body, body.points_of(t)); });
    BoxTree::meet(table_, cloth.tree, body.tree, add);
    return;
  }
  if (!body.seen(cloth.tree.box()).meets(body.tree.box())) return;
  seen_cloth_.refit([&](std::uint32_t t) { return points.in_tree(body, cloth.points_of(t)); });
  BoxTree::meet(table_, seen_cloth_, body.tree, add);
}

bool CandidateSearch::find(ContactPoints& points, Candidates& candidates) {
  if (points.has_tubes()) return renew(points, candidates);
  points.lay_tubes();
  ContactSurface& cloth = points.surfaces()[kClothSurface];
  cloth.tree.refit([&](std::uint32_t t) { return points.in_tree(cloth, cloth.points_of(t)); });
  if (owner_of_edge_.empty()) find_owners(cloth);
  for (PairList& list : candidates) list.clear();
  for (const SurfacePair pair : points.surface_pairs()) find_all(points, pair, candidates);
  if (points.touches_itself()) find_within_cloth(points, candidates);
  return true;
}

namespace {

constexpr SurfacePair kWithinCloth{kClothSurface, kClothSurface};

}  // namespace

/// Each pair of triangles once.
void CandidateSearch::find_within_cloth(ContactPoints& points, Candidates& candidates) const {
  const ContactSurface& cloth = points.surfaces()[kClothSurface];
  OwnedFeatures features(points, kWithinCloth, candidates);
  BoxTree::meet(table_, cloth.tree, cloth.tree, [&](std::uint32_t a, std::uint32_t b) {
    if (b <= a) return;
    if (features.triangle() != a) features.begin(a);
    features.add(b);
  });
}

/// The tree holds what has not been renewed where it was when tubes were laid; the rest is put
/// there now.
void CandidateSearch::renew_within_cloth(ContactPoints& points, Candidates& candidates) const {
  ContactSurface& cloth = points.surfaces()[kClothSurface];
  cloth.tree.refit([&](std::uint32_t t) { return points.in_tree(cloth, cloth.points_of(t)); });
  OwnedFeatures features(points, kWithinCloth, candidates);
  for (std::uint32_t t = 0; t < cloth.triangles->triangles.size(); ++t) {
    if (is_renewed_[t] == 0) continue;
    features.begin(t);
    cloth.tree.find(table_, points.in_tree(cloth, cloth.points_of(t)), [&](std::uint32_t other) {
      if (other != t && (is_renewed_[other] == 0 || other > t)) features.add(other);
    });
  }
}

void CandidateSearch::find_within_cloth_beside(ContactPoints& points,
                                               std::span<const std::uint8_t> has_strayed,
                                               Candidates& candidates) const {
  ContactSurface& cloth = points.surfaces()[kClothSurface];
  cloth.tree.refit([&](std::uint32_t t) { return points.in_tree(cloth, cloth.points_of(t)); });
  const auto strays = [&](std::uint32_t t) {
    const auto [a, b, c] = cloth.triangles->triangles[t];
    return (has_strayed[a] | has_strayed[b] | has_strayed[c]) != 0;
  };
  OwnedFeatures features(points, kWithinCloth, candidates);
  for (std::uint32_t t = 0; t < cloth.triangles->triangles.size(); ++t) {
    if (!strays(t)) continue;
    features.begin(t);
    cloth.tree.find(table_, points.in_tree(cloth, cloth.points_of(t)), [&](std::uint32_t other) {
      if (other != t && (other > t || !strays(other))) features.add(other);
    });
  }
}

void CandidateSearch::find_owners(const ContactSurface& cloth) {
  const TriangleSurface& s = *cloth.triangles;
  seen_cloth_ = cloth.tree;
  owner_of_edge_.resize(s.edges.size());
  owner_of_point_.resize(s.triangles_at.size());
  has_moved_.resize(s.triangles_at.size());
  is_renewed_.resize(s.triangles.size());
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (s.owns_corner(t, k)) owner_of_point_[s.triangles[t][k]] = t;
      if (s.owns_edge(t, k)) owner_of_edge_[s.edges_of[t][k]] = t;
    }
  }
}

/// The triangle of the cloth that owns its feature of the pair.
std::uint32_t CandidateSearch::owner(const Pair& pair) const {
  if (pair.kind == PairKind::edges) return owner_of_edge_[pair.first];
  return pair.is_turned() ? pair.second : owner_of_point_[pair.first];
}
/// Of a pair within the cloth.
std::uint32_t CandidateSearch::owner_of_second(const Pair& pair) const {
  return pair.kind == PairKind::edges ? owner_of_edge_[pair.second] : pair.second;
}

/// Candidates of triangles with a corner that has left its tube, and of these alone.
bool CandidateSearch::renew(ContactPoints& points, Candidates& candidates) {
  std::ranges::fill(has_moved_, std::uint8_t{0});
  bool any = false;
  points.renew_tubes([&](std::uint32_t slot) {
    has_moved_[slot] = 1;
    any = true;
  });
  if (!any) return false;
  const TriangleSurface& cloth = points.cloth();
  Box all = Box::none();
  for (std::uint32_t t = 0; t < cloth.triangles.size(); ++t) {
    const auto [a, b, c] = cloth.triangles[t];
    is_renewed_[t] = has_moved_[a] | has_moved_[b] | has_moved_[c];
    if (is_renewed_[t] != 0)
      all.add(points.in_tree(points.surfaces()[kClothSurface], cloth.triangles[t]));
  }
  bool have_moved = false;
  for (PairList& list : candidates) {
    have_moved = list.leave_out([&](const Pair& pair) {
      return is_renewed_[owner(pair)] != 0 ||
             (pair.is_within_cloth() && is_renewed_[owner_of_second(pair)] != 0);
    }) || have_moved;
  }
  for (const SurfacePair pair : points.surface_pairs()) {
    const ContactSurface& body = points.surfaces()[pair.b];
    if (!body.as_in_tree(all).meets(body.tree.box())) continue;
    OwnedFeatures features(points, pair, candidates);
    for (std::uint32_t t = 0; t < cloth.triangles.size(); ++t) {
      if (is_renewed_[t] == 0) continue;
      features.begin(t);
      body.tree.find(table_, points.in_tree(body, cloth.triangles[t]),
                     [&](std::uint32_t other) { features.add(other); });
    }
  }
  if (points.touches_itself()) renew_within_cloth(points, candidates);
  return have_moved;
}

void CandidateSearch::find_beside(ContactPoints& points, std::uint32_t triangle, const Box& box,
                                  Candidates& candidates) const {
  for (const SurfacePair pair : points.surface_pairs()) {
    OwnedFeatures features(points, pair, candidates);
    const Tube tube{box, box};
    features.begin(triangle, {tube, tube, tube});
    const ContactSurface& body = points.surfaces()[pair.b];
    body.tree.find(table_, body.as_in_tree(box), [&](std::uint32_t other) { features.add(other); });
  }
}

std::size_t CandidateSearch::bytes() const {
  return seen_cloth_.bytes() + bytes_of(has_moved_) + bytes_of(is_renewed_) +
         bytes_of(owner_of_edge_) + bytes_of(owner_of_point_);
}

}  // namespace weft
