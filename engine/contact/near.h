/// Stage 3 of an interval: which candidates may touch within it. Their distance is measured once,
/// in lanes; near are those that come nearer than the thickness if points go on as expected, but
/// for the reach.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/contact/candidates.h"
#include "engine/contact/near_pairs.h"
#include "engine/contact/tangles.h"
#include "engine/parallel/team.h"

namespace weft {

/// What is known of a list of candidates.
struct Distances {
  std::vector<std::array<float, kernels::kLanes>> distance;  // m, when the interval begins
  std::vector<std::uint16_t> near;                           // per block, a bit per lane

  void resize(std::size_t blocks) {
    distance.resize(blocks);
    near.resize(blocks);
  }
};

class NearSearch {
 public:
  explicit NearSearch(const simd::Table& table) : table_(table) {}

  void measure(const ContactPoints& points, const Candidates& candidates, Team& team);
  /// Pairs with a surface that the cloth is behind are left out, but for particles that are known
  /// to be inside: the cloth lies beside another surface there.
  void find(ContactPoints& points, const Candidates& candidates, const Tangles& tangles,
            Near& near) const;
  const std::array<Distances, kPairLists>& distances() const { return distances_; }
  std::array<Distances, kPairLists>& distances() { return distances_; }
  std::size_t bytes() const;

 private:
  const simd::Table& table_;
  std::array<Distances, kPairLists> distances_;
};

}  // namespace weft
