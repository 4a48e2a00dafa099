#include "engine/contact/candidates.h"
#include "engine/contact/owned_features.h"

namespace weft {

namespace {

constexpr SurfacePair kWithinCloth{kClothSurface, kClothSurface};

bool share_a_corner(const TriangleSurface::Triangle& a, const TriangleSurface::Triangle& b) {
  bool share = false;
  for (const std::uint32_t mine : a) share |= mine == b[0] || mine == b[1] || mine == b[2];
  return share;
}

}  // namespace

/// Each pair of triangles once.
void CandidateSearch::find_within_cloth(ContactPoints& points, Candidates& candidates) {
  const ContactSurface& cloth = points.surfaces()[kClothSurface];
  const auto& triangles = cloth.triangles->triangles;
  if (stars_.empty()) stars_.make(points);
  stars_.begin();
  OwnedFeatures features(table_, points, kWithinCloth, candidates);
  BoxTree::meet_itself(table_, cloth.tree(), [&](std::uint32_t a, std::uint32_t b) {
    if (share_a_corner(triangles[a], triangles[b])) return;
    if (features.triangle() != a) features.begin(a);
    features.add(b);
  });
  features.finish();
}

/// Finds candidates of renewed triangles. The tree holds the others where they were when tubes were
/// laid; the rest is put there now.
void CandidateSearch::find_within_cloth_of(ContactPoints& points, Candidates& candidates) {
  ContactSurface& cloth = points.surfaces()[kClothSurface];
  const auto& triangles = cloth.triangles->triangles;
  cloth.own_tree.refit([&](std::uint32_t t) { return points.in_tree(cloth, cloth.points_of(t)); });
  OwnedFeatures features(table_, points, kWithinCloth, candidates);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (is_renewed_[t] == 0) continue;
    cloth.tree().find(table_, points.in_tree(cloth, cloth.points_of(t)), [&](std::uint32_t other) {
      if (is_renewed_[other] != 0 && other < t) return;
      if (share_a_corner(triangles[t], triangles[other])) return;
      if (features.triangle() != t) features.begin(t);
      features.add(other);
    });
  }
  features.finish();
}

void CandidateSearch::find_within_cloth_beside(ContactPoints& points,
                                               std::span<const std::uint8_t> has_strayed,
                                               Candidates& candidates) {
  const auto& triangles = points.cloth().triangles;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const auto [a, b, c] = triangles[t];
    is_renewed_[t] = has_strayed[a] | has_strayed[b] | has_strayed[c];
  }
  find_within_cloth_of(points, candidates);
}

}  // namespace weft
