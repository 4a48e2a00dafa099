/// Stage 3 of an interval finds the candidates that may touch within it. Lanes measure their
/// distances. A pair is near if its points, moving as expected, may come nearer than the thickness
/// plus the reach. Pairs that are too far apart for this sleep until the points of both surfaces
/// may have come that far.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/contact/candidates.h"
#include "engine/contact/contacts.h"
#include "engine/contact/near_pairs.h"
#include "engine/contact/tangles.h"
#include "engine/parallel/team.h"

namespace weft {

/// The known distances of a list of candidates.
struct Distances {
  using Lanes = std::array<float, kernels::kLanes>;
  std::vector<Lanes> distance;  // m: kSurelyApart of it, less what points have travelled, is the
                                // least that a pair may be apart
  std::vector<std::uint16_t> near, awake;  // per block, a bit per lane
  // Of pairs within the cloth: which are contacts, as bits and by their names (NearContacts).
  std::vector<std::uint16_t> contacts;
  std::vector<std::uint32_t> names;
  std::size_t count = 0;  // of the pairs that are known

  void resize(std::size_t blocks) {
    distance.resize(blocks);
    near.resize(blocks);
    awake.resize(blocks);
  }
  float (*lanes())[kernels::kLanes] {
    return reinterpret_cast<float(*)[kernels::kLanes]>(distance.data());
  }
  const float (*lanes() const)[kernels::kLanes] {
    return reinterpret_cast<const float(*)[kernels::kLanes]>(distance.data());
  }
};

/// far: it is not near. asks_side: it is in front of the later surface or behind it, or far.
/// touches: it may be any of these.
enum class Sight : std::uint8_t { far, in_front, behind, asks_side, touches };

/// How a pair looks that may be near.
struct SeenPair {
  Sight sight = Sight::far;
  bool is_inside = false, is_placed = false;  // placed: no neighbour may take its place
  Look look{};
};

class NearSearch {
 public:
  explicit NearSearch(const simd::Table& table) : table_(table) {}

  /// When an interval begins. have_moved: candidates have other places than before.
  void measure(const ContactPoints& points, const Candidates& candidates, bool have_moved,
               Team& team);
  /// Those that were added since.
  void measure_new(const ContactPoints& points, const Candidates& candidates, Team& team);
  /// m: a pair is no nearer than this when the interval begins, or overlaps.
  float least(std::size_t list, std::size_t pair) const {
    const Distances::Lanes& lanes = distances_[list].distance[pair / kernels::kLanes];
    return simd::kSurelyApart * lanes[pair % kernels::kLanes] - travelled_;
  }
  /// m: since candidates were found, by two points beside each other, at most.
  float travelled() const { return travelled_; }
  /// Those of the cloth with bodies. Pairs with a surface that the cloth is behind are left out,
  /// but for particles that are known to be inside: the cloth lies beside another surface there.
  void find(ContactPoints& points, const Candidates& candidates, const Tangles& tangles, Near& near,
            Team& team);
  /// Those of the cloth with itself: contacts leave to neighbours what is theirs. Not anew:
  /// contacts are those of the interval before, but for what is found, and what is no candidate any
  /// more.
  void find_layers(ContactPoints& points, const Candidates& candidates, const Tangles& tangles,
                   NearContacts& layers);
  const std::array<Distances, kPairLists>& distances() const { return distances_; }
  std::size_t bytes() const;

 private:
  simd::PairMeasure measure_of(const ContactPoints& points, const PairList& pairs,
                               Distances& distances) const;
  void measure_blocks(const simd::PairMeasure& measure, std::size_t list, const PairList& pairs,
                      std::size_t first, std::size_t last);
  void measure_awake(const simd::PairMeasure& measure, std::size_t list, const PairList& pairs,
                     std::size_t first, std::size_t last);
  void give_names(const Candidates& candidates, NearContacts& layers);
  class Gathered;

  const simd::Table& table_;
  float travelled_ = 0;
  std::array<Distances, kPairLists> distances_;
  std::uint32_t names_ = 0;             // of contacts
  std::vector<std::size_t> looked_at_;  // pairs; scratch
  std::vector<SeenPair> seen_;          // likewise
};

}  // namespace weft
