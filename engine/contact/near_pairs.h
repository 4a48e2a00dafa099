/// Pairs that may touch within an interval, and the state of each.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/contact/features.h"
#include "kernels/reference/bodies.h"

namespace weft {

/// A near pair, and the effect of its contact in the present substep.
struct NearState {
  double thickness = 0;      // m
  bool is_touching = false;  // in this substep
  bool is_linked = false;    // in this substep: local passes know it by its points
  double push = 0;           // m, along the normal, in this substep
  reference::ContactSums sums{};
};

/// Near pairs of one list of the cloth with bodies.
struct NearPairs {
  PairList list;
  kernels::AlignedVector<simd::PairSide> sides;  // per block
  std::vector<NearState> states;                 // per pair
  std::vector<std::uint16_t> turned;             // per block, a bit per lane: Pair::is_turned()

  void clear() {
    list.clear();
    sides.clear();
    states.clear();
    turned.clear();
  }
  void add(const Pair& pair, const std::array<std::uint32_t, 4>& points, kernels::Vector normal,
           double thickness, bool is_under);
  /// Its place, or size().
  std::size_t find(const Pair& pair) const {
    return static_cast<std::size_t>(std::ranges::find(list.pairs, pair) - list.pairs.begin());
  }
  /// Whether one is on the wrong side of the other.
  bool is_under(std::size_t i) const { return (sides[i / kernels::kLanes].used & under(i)) != 0; }
  void set_under(std::size_t i, bool is_under) {
    std::uint32_t& used = sides[i / kernels::kLanes].used;
    used = is_under ? used | under(i) : used & ~under(i);
  }
  /// From the second feature to the first, as last seen there.
  kernels::Vector normal(std::size_t i) const;
  void set_normal(std::size_t i, kernels::Vector normal);

 private:
  static std::uint32_t under(std::size_t i) {
    return std::uint32_t{1} << (kernels::kLanes + i % kernels::kLanes);
  }
};
using Near = std::array<NearPairs, kBodyLists>;

}  // namespace weft
