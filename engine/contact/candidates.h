/// Stage 2 of an interval: which pairs of features may meet at all. Wide boxes hold all places that
/// points are expected to come to, for some intervals; while they do candidates stay. Candidates of
/// points that leave their boxes are looked for anew (verify.h). The order of candidates does not
/// depend on the boxes, but on the trees alone.
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

  /// Where wide boxes no longer hold: renews them, refits all trees, and finds the candidates.
  void find(ContactPoints& points, Candidates& candidates);
  /// Adds candidates of a triangle of the cloth within a box of its own.
  void find_beside(const ContactPoints& points, std::uint32_t triangle, const Box& box,
                   Candidates& candidates) const;
  std::size_t bytes() const { return has_moved_.capacity(); }

 private:
  bool still_holds(ContactPoints& points);

  const simd::Table& table_;
  std::vector<std::uint8_t> has_moved_;  // per slot, out of its wide box; scratch
};

}  // namespace weft
