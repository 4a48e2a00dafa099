/// Stage 3 of contacts with meshes: which candidates may touch within the interval. Their distance
/// is measured once, in lanes; near are those that come nearer than the thickness if points go on
/// as expected, but for the reach.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/contact/candidates.h"
#include "engine/contact/misplaced.h"
#include "engine/contact/tangles.h"
#include "engine/parallel/team.h"
#include "kernels/reference/bodies.h"

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

/// A pair that may touch in this interval, and what its contact has done in the present substep.
struct NearState {
  bool is_under = false;     // the cloth is on the wrong side
  bool is_touching = false;  // in this substep
  double push = 0;           // m, along the normal, in this substep
  reference::Grip grip{};
};

/// Near pairs of one list.
struct NearPairs {
  PairList list;
  kernels::AlignedVector<simd::PairSide> sides;  // per block
  std::vector<NearState> states;                 // per pair

  void clear() {
    list.clear();
    sides.clear();
    states.clear();
  }
  void add(const Pair& pair, const std::array<std::uint32_t, 4>& points, kernels::Vector normal,
           double thickness, bool is_under);
  /// Its place, or size().
  std::size_t find(const Pair& pair) const {
    return static_cast<std::size_t>(std::ranges::find(list.pairs, pair) - list.pairs.begin());
  }
  /// From the second feature to the first, as last seen there.
  kernels::Vector normal(std::size_t i) const;
  void set_normal(std::size_t i, kernels::Vector normal);
};
using Near = std::array<NearPairs, kPairLists>;

class NearSearch {
 public:
  explicit NearSearch(const simd::Table& table) : table_(table) {}

  void measure(const ContactPoints& points, const Candidates& candidates, Team& team);
  /// Pairs with a surface that the cloth is behind are left out, but for particles that are known
  /// to be inside: the cloth lies beside another surface there.
  void find_near(const Model& model, ContactPoints& points, const Candidates& candidates,
                 Near& near, const Misplaced& misplaced, const Tangles& tangles) const;
  const std::array<Distances, kPairLists>& distances() const { return distances_; }
  std::array<Distances, kPairLists>& distances() { return distances_; }
  std::size_t bytes() const;

 private:
  static bool can_move(const Model& model, const Pair& pair,
                       const std::array<std::uint32_t, 4>& points);
  static bool may_meet(const ContactPoints& points, PairKind kind,
                       const std::array<std::uint32_t, 4>& four);
  static double closing(const ContactPoints& points, PairKind kind,
                        const std::array<std::uint32_t, 4>& four, kernels::Vector n);
  /// Whether it is to be looked at; sets the normal and whether it is under.
  static bool see(const Model& model, ContactPoints& points, const Pair& pair,
                  const std::array<std::uint32_t, 4>& four, bool is_inside, kernels::Vector& normal,
                  bool& is_under);

  const simd::Table& table_;
  std::array<Distances, kPairLists> distances_;
};

}  // namespace weft
