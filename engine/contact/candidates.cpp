#include "engine/contact/candidates.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "engine/bytes_of.h"

namespace weft {
namespace {

/// Adds the pairs of features that a triangle of one surface and those of another one own. By x, y
/// and z alone big boxes of slanted triangles and edges meet those of dozens that lie beside them:
/// tubes are to meet along the normal of the first triangle, and in its plane across its edges,
/// too.
class OwnedFeatures {
 public:
  OwnedFeatures(const simd::Table& table, ContactPoints& points, SurfacePair surfaces,
                Candidates& candidates)
      : table_(table),
        points_(points),
        surfaces_(surfaces),
        a_(points.surfaces()[surfaces.a]),
        b_(points.surfaces()[surfaces.b]),
        may_cross_(points.surfaces()[surfaces.b].may_cross),
        candidates_(candidates) {}

  /// The triangle of the first surface that others are beside from now on.
  void begin(std::uint32_t a) {
    const TriangleSurface::Triangle points = a_.points_of(a);
    for (const std::uint32_t point : points) points_.tube(point);
    const simd::PointTube* tubes = points_.lane_tubes();
    begin(a, {tubes + points[0], tubes + points[1], tubes + points[2]});
  }
  /// tubes: of its corners.
  void begin(std::uint32_t a, const std::array<const simd::PointTube*, 3>& tubes) {
    finish();
    triangle_a_ = a;
    corners_a_ = a_.points_of(a);
    set_axes();
    table_.reaches_of_triangle(axes_, tubes.data(), reaches_);
  }
  std::uint32_t triangle() const { return triangle_a_; }
  /// It is beside that of the second surface.
  void add(std::uint32_t b) {
    if (waiting_ == kernels::kLanes) finish();
    const TriangleSurface::Triangle corners = b_.points_of(b);
    for (std::size_t k = 0; k < 3; ++k) {
      points_.tube(corners[k]);
      corners_b_[waiting_][k] = corners[k];
    }
    wanted_[waiting_] = owned_with(b);
    triangles_b_[waiting_++] = b;
  }
  /// Adds the features of all that were told.
  void finish() {
    if (waiting_ == 0) return;
    table_.meet_triangles({.axes = &axes_,
                           .reaches = &reaches_,
                           .tubes = points_.lane_tubes(),
                           .corners = corners_b_.data(),
                           .wanted = wanted_.data(),
                           .met = met_.data()},
                          waiting_);
    for (std::size_t i = 0; i < waiting_; ++i) {
      if (met_[i] != 0) add_features(i, met_[i]);
    }
    waiting_ = 0;
  }

 private:
  /// Bits of simd::TriangleMeeting: the features that both triangles own.
  std::uint16_t owned_with(std::uint32_t b) const {
    const std::uint32_t of_a = a_.triangles->owns[triangle_a_], of_b = b_.triangles->owns[b];
    std::uint32_t owned = (of_a & 7) << 1;
    if (a_.triangles->is_point(triangle_a_)) return static_cast<std::uint16_t>(owned);
    owned |= (of_b & 7) << 4;
    for (std::uint32_t j = 0; j < 3; ++j) {
      if (b_.triangles->owns_edge(b, j)) owned |= (of_a >> 3 & 7) << (7 + 3 * j);
    }
    return static_cast<std::uint16_t>(owned);
  }
  void add_features(std::size_t i, std::uint32_t met) {
    may_cross_[triangle_a_] = 1;
    for (std::uint32_t left = met & ~1u; left != 0; left &= left - 1)
      add_feature(triangles_b_[i], corners_b_[i], static_cast<std::size_t>(std::countr_zero(left)));
  }
  /// Of the triangle b, which has these corners.
  void add_feature(std::uint32_t b, const std::uint32_t (&corners)[3], std::size_t bit) {
    if (bit < 4) {
      const std::uint32_t point = corners_a_[bit - 1];
      add_pair({point - a_.first_point, b, surfaces_.a, surfaces_.b, PairKind::point_triangle},
               {point, corners[0], corners[1], corners[2]}, b);
    } else if (bit < 7) {
      const std::uint32_t point = corners[bit - 4];
      add_pair(
          {point - b_.first_point, triangle_a_, surfaces_.b, surfaces_.a, PairKind::point_triangle},
          {point, corners_a_[0], corners_a_[1], corners_a_[2]}, b);
    } else {
      const std::size_t j = (bit - 7) / 3, k = (bit - 7) % 3;
      add_pair({a_.triangles->edges_of[triangle_a_][k], b_.triangles->edges_of[b][j], surfaces_.a,
                surfaces_.b, PairKind::edges},
               {corners_a_[k], corners_a_[(k + 1) % 3], corners[j], corners[(j + 1) % 3]}, b);
    }
  }
  /// Where the interval begins. Lengths do not matter.
  void set_axes() {
    const kernels::Vector x[] = {points_.start(corners_a_[0]), points_.start(corners_a_[1]),
                                 points_.start(corners_a_[2])};
    const kernels::Vector n = cross(x[1] - x[0], x[2] - x[0]);
    set_axis(0, n);
    for (std::size_t k = 0; k < 3; ++k) set_axis(1 + k, cross(n, x[(k + 1) % 3] - x[k]));
  }
  void set_axis(std::size_t i, kernels::Vector v) {
    const double l = length(v), scale = l > 0 ? 1 / l : 0;
    for (const std::size_t lane : {4 + i, 12 + i}) {
      axes_.x[lane] = static_cast<float>(scale * v.x);
      axes_.y[lane] = static_cast<float>(scale * v.y);
      axes_.z[lane] = static_cast<float>(scale * v.z);
    }
  }
  static bool share_a_point(PairKind kind, const std::array<std::uint32_t, 4>& points) {
    const auto [a, b, c, d] = points;
    const bool first = a == c || a == d;
    return first || (kind == PairKind::edges ? b == c || b == d : a == b);
  }
  void add_pair(const Pair& pair, const std::array<std::uint32_t, 4>& points, std::uint32_t b) {
    if (pair.is_within_cloth() && share_a_point(pair.kind, points)) return;
    candidates_[list_of(pair.kind)].add(pair, points);
    if (pair.is_within_cloth()) return;
    if (std::exchange(active_, b) != b) points_.activate(surfaces_.b, b);
  }

  const simd::Table& table_;
  ContactPoints& points_;
  const SurfacePair surfaces_;
  const ContactSurface &a_, &b_;
  std::vector<std::uint8_t>& may_cross_;
  Candidates& candidates_;
  std::uint32_t triangle_a_ = kNoIndex, active_ = kNoIndex;
  TriangleSurface::Triangle corners_a_{};
  simd::ReachAxes axes_;
  simd::TriangleReaches reaches_{};
  std::size_t waiting_ = 0;
  std::array<std::uint32_t, kernels::kLanes> triangles_b_{};
  std::array<std::uint32_t[3], kernels::kLanes> corners_b_{};
  std::array<std::uint16_t, kernels::kLanes> wanted_{}, met_{};
};

}  // namespace

Box SeenTubes::box(ContactPoints& points, const ContactSurface& body,
                   const TriangleSurface::Triangle& corners) {
  Box all = Box::none();
  for (const std::uint32_t corner : corners) {
    if (std::exchange(seen_for_[corner], bodies_) != bodies_)
      boxes_[corner] = body.as_in_tree(points.tube(corner));
    all.add(boxes_[corner]);
  }
  return all;
}

void CandidateSearch::find_all(ContactPoints& points, SurfacePair pair, Candidates& candidates) {
  ContactSurface& body = points.surfaces()[pair.b];
  const ContactSurface& cloth = points.surfaces()[pair.a];
  OwnedFeatures features(table_, points, pair, candidates);
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    if (features.triangle() != a) features.begin(a);
    features.add(b);
  };
  if (!body.is_rigid) {
    body.tree.refit([&](std::uint32_t t) { return points.in_tree(body, body.points_of(t)); });
    BoxTree::meet(table_, cloth.tree, body.tree, add);
    features.finish();
    return;
  }
  if (!body.seen(cloth.tree.box()).meets(body.tree.box())) return;
  seen_.begin();
  seen_cloth_.refit([&](std::uint32_t t) { return seen_.box(points, body, cloth.points_of(t)); });
  BoxTree::meet(table_, seen_cloth_, body.tree, add);
  features.finish();
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
  OwnedFeatures features(table_, points, kWithinCloth, candidates);
  BoxTree::meet(table_, cloth.tree, cloth.tree, [&](std::uint32_t a, std::uint32_t b) {
    if (b <= a) return;
    if (features.triangle() != a) features.begin(a);
    features.add(b);
  });
  features.finish();
}

/// The tree holds what has not been renewed where it was when tubes were laid; the rest is put
/// there now.
void CandidateSearch::renew_within_cloth(ContactPoints& points, Candidates& candidates) const {
  ContactSurface& cloth = points.surfaces()[kClothSurface];
  cloth.tree.refit([&](std::uint32_t t) { return points.in_tree(cloth, cloth.points_of(t)); });
  OwnedFeatures features(table_, points, kWithinCloth, candidates);
  for (std::uint32_t t = 0; t < cloth.triangles->triangles.size(); ++t) {
    if (is_renewed_[t] == 0) continue;
    features.begin(t);
    cloth.tree.find(table_, points.in_tree(cloth, cloth.points_of(t)), [&](std::uint32_t other) {
      if (other != t && (is_renewed_[other] == 0 || other > t)) features.add(other);
    });
  }
  features.finish();
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
  OwnedFeatures features(table_, points, kWithinCloth, candidates);
  for (std::uint32_t t = 0; t < cloth.triangles->triangles.size(); ++t) {
    if (!strays(t)) continue;
    features.begin(t);
    cloth.tree.find(table_, points.in_tree(cloth, cloth.points_of(t)), [&](std::uint32_t other) {
      if (other != t && (other > t || !strays(other))) features.add(other);
    });
  }
  features.finish();
}

void CandidateSearch::find_owners(const ContactSurface& cloth) {
  const TriangleSurface& s = *cloth.triangles;
  seen_cloth_ = cloth.tree;
  seen_.resize(s.triangles_at.size());
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
    OwnedFeatures features(table_, points, pair, candidates);
    seen_.begin();
    for (std::uint32_t t = 0; t < cloth.triangles.size(); ++t) {
      if (is_renewed_[t] == 0) continue;
      body.tree.find(table_, seen_.box(points, body, cloth.triangles[t]), [&](std::uint32_t other) {
        if (features.triangle() != t) features.begin(t);
        features.add(other);
      });
    }
    features.finish();
  }
  if (points.touches_itself()) renew_within_cloth(points, candidates);
  return have_moved;
}

void CandidateSearch::find_beside(ContactPoints& points, std::uint32_t triangle, const Box& box,
                                  Candidates& candidates) const {
  for (const SurfacePair pair : points.surface_pairs()) {
    OwnedFeatures features(table_, points, pair, candidates);
    const simd::PointTube tube = Tube{box, box}.in_lanes();
    features.begin(triangle, {&tube, &tube, &tube});
    const ContactSurface& body = points.surfaces()[pair.b];
    body.tree.find(table_, body.as_in_tree(box), [&](std::uint32_t other) { features.add(other); });
    features.finish();
  }
}

std::size_t CandidateSearch::bytes() const {
  return seen_cloth_.bytes() + seen_.bytes() + bytes_of(has_moved_) + bytes_of(is_renewed_) +
         bytes_of(owner_of_edge_) + bytes_of(owner_of_point_);
}

}  // namespace weft
