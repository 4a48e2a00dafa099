/// Stage 2 of contacts with meshes: which pairs of features may meet in an interval at all. Hulls,
/// which are boxes, hold all places that points are expected to come to, for some intervals; while
/// they do candidates stay. Who leaves its box is looked for anew (verification.h). The order of
/// candidates does not depend on the boxes, but on the trees alone.
#pragma once

#include <array>

#include "engine/contact/features.h"
#include "engine/contact/points.h"

namespace weft {

/// Candidates, by lists of pairs.
using Candidates = std::array<PairList, kPairLists>;

class CandidateSearch {
 public:
  explicit CandidateSearch(const simd::Table& table) : table_(table) {}

  /// Where hulls no longer hold: renews them, refits all trees, and finds the candidates.
  void find(const TriangleSurface& cloth, ContactPoints& points, Candidates& candidates);
  /// Adds candidates of a triangle of the cloth within a box of its own.
  void find_beside(const TriangleSurface& cloth, const ContactPoints& points,
                   std::uint32_t triangle, const Box& box, Candidates& candidates) const;
  std::size_t bytes() const { return tree_.bytes() + has_moved_.capacity(); }

 private:
  bool still_holds(const TriangleSurface& cloth, ContactPoints& points);

  const simd::Table& table_;
  BoxTree tree_;  // of the triangles of the cloth
  bool is_built_ = false;
  std::vector<std::uint8_t> has_moved_;  // per slot, out of its hull; scratch
};

}  // namespace weft
