/// Stage 3 of an interval: which candidates may touch within it. Their distance is measured in
/// lanes; near are those that come nearer than the thickness if points go on as expected, but for
/// the reach. Blocks of pairs that are too far apart to become near sleep until the points of both
/// surfaces may have come that far.
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
  std::vector<std::array<float, kernels::kLanes>> distance;  // m, when it was measured
  std::vector<std::uint16_t> near;                           // per block, a bit per lane
  std::vector<float> least;          // m, per block: a distance that none is below, and what points
                                     // had travelled by then
  std::vector<std::uint8_t> sleeps;  // per block: the distance is of another interval
  std::size_t count = 0;             // of the pairs that are known

  void resize(std::size_t blocks) {
    distance.resize(blocks);
    near.resize(blocks);
    least.resize(blocks);
    sleeps.resize(blocks);
  }
};

class NearSearch {
 public:
  explicit NearSearch(const simd::Table& table) : table_(table) {}

  /// When an interval begins. have_moved: candidates have other places than before.
  void measure(const ContactPoints& points, const Candidates& candidates, bool have_moved,
               Team& team);
  /// Those that were added since.
  void measure_new(const ContactPoints& points, const Candidates& candidates, Team& team);
  /// m: pairs of a block are no nearer than this when the interval begins, or overlap.
  float least(std::size_t list, std::size_t block) const {
    return distances_[list].least[block] - travelled_;
  }
  /// Measures a block that sleeps as the interval began.
  void wake(const ContactPoints& points, const Candidates& candidates, std::size_t list,
            std::size_t block);
  /// Pairs with a surface that the cloth is behind are left out, but for particles that are known
  /// to be inside: the cloth lies beside another surface there.
  void find(ContactPoints& points, const Candidates& candidates, const Tangles& tangles,
            Near& near) const;
  const std::array<Distances, kPairLists>& distances() const { return distances_; }
  std::size_t bytes() const;

 private:
  simd::PairMeasure measure_of(const ContactPoints& points, const PairList& pairs,
                               Distances& distances) const;
  void measure_block(const simd::PairMeasure& measure, std::size_t list, const PairList& pairs,
                     std::size_t block);

  const simd::Table& table_;
  float travelled_ = 0;  // m: since candidates were found, by two points beside each other, at most
  std::array<Distances, kPairLists> distances_;
};

}  // namespace weft
