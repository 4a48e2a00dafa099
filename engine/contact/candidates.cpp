#include "engine/contact/candidates.h"

#include <algorithm>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/contact/owned_features.h"

namespace weft {

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
    body.own_tree.refit([&](std::uint32_t t) { return points.in_tree(body, body.points_of(t)); });
    BoxTree::meet(table_, cloth.tree(), body.tree(), add);
    features.finish();
    return;
  }
  if (!body.seen(cloth.tree().box()).meets(body.tree().box())) return;
  seen_.begin();
  seen_cloth_.refit([&](std::uint32_t t) { return seen_.box(points, body, cloth.points_of(t)); });
  BoxTree::meet(table_, seen_cloth_, body.tree(), add);
  features.finish();
}

bool CandidateSearch::find(ContactPoints& points, Candidates& candidates, Team& team) {
  const bool have_moved = find_again(points, candidates);
  if (points.touches_itself()) stars_.add_folded(points, Stars::Fold::comes_near, candidates, team);
  return have_moved;
}

bool CandidateSearch::find_again(ContactPoints& points, Candidates& candidates) {
  if (points.has_tubes()) return renew(points, candidates);
  points.lay_tubes();
  ContactSurface& cloth = points.surfaces()[kClothSurface];
  cloth.own_tree.refit([&](std::uint32_t t) { return points.in_tree(cloth, cloth.points_of(t)); });
  if (owner_of_edge_.empty()) find_owners(cloth);
  for (PairList& list : candidates) list.clear();
  for (const SurfacePair pair : points.surface_pairs()) find_all(points, pair, candidates);
  if (points.touches_itself()) find_within_cloth(points, candidates);
  return true;
}

void CandidateSearch::find_owners(const ContactSurface& cloth) {
  const TriangleSurface& s = *cloth.triangles;
  seen_cloth_ = cloth.tree();
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
/// The owner of the second feature of a pair within the cloth.
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
  for (std::size_t list = 0; list < kPairLists; ++list) {
    if (is_of_stars(list)) continue;
    have_moved = candidates[list].leave_out([&](const Pair& pair) {
      return is_renewed_[owner(pair)] != 0 ||
             (pair.is_within_cloth() && is_renewed_[owner_of_second(pair)] != 0);
    }) || have_moved;
  }
  for (const SurfacePair pair : points.surface_pairs()) {
    const ContactSurface& body = points.surfaces()[pair.b];
    if (!body.as_in_tree(all).meets(body.tree().box())) continue;
    OwnedFeatures features(table_, points, pair, candidates);
    seen_.begin();
    for (std::uint32_t t = 0; t < cloth.triangles.size(); ++t) {
      if (is_renewed_[t] == 0) continue;
      body.tree().find(table_, seen_.box(points, body, cloth.triangles[t]),
                       [&](std::uint32_t other) {
                         if (features.triangle() != t) features.begin(t);
                         features.add(other);
                       });
    }
    features.finish();
  }
  if (points.touches_itself()) find_within_cloth_of(points, candidates);
  return have_moved;
}

void CandidateSearch::find_beside(ContactPoints& points, std::uint32_t triangle, const Box& box,
                                  Candidates& candidates) const {
  for (const SurfacePair pair : points.surface_pairs()) {
    OwnedFeatures features(table_, points, pair, candidates);
    const simd::PointTube tube = Tube{box, box}.in_lanes();
    features.begin(triangle, {&tube, &tube, &tube});
    const ContactSurface& body = points.surfaces()[pair.b];
    body.tree().find(table_, body.as_in_tree(box),
                     [&](std::uint32_t other) { features.add(other); });
    features.finish();
  }
}

std::size_t CandidateSearch::bytes() const {
  return seen_cloth_.bytes() + seen_.bytes() + bytes_of(has_moved_) + bytes_of(is_renewed_) +
         bytes_of(owner_of_edge_) + bytes_of(owner_of_point_) + stars_.bytes();
}

}  // namespace weft
