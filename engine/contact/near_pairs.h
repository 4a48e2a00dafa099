/// Pairs that may touch within an interval, and what is known of each.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/contact/features.h"
#include "kernels/reference/bodies.h"
#include "kernels/simd/touch_data.h"

namespace weft {

/// Near pairs of one list.
struct NearPairs {
  PairList list;  // once they are arranged with lanes that are not used
  kernels::AlignedVector<simd::PairSide> sides;  // per block
  std::vector<std::uint16_t> turned;             // per block, a bit per lane: Pair::is_turned()
  std::vector<std::uint16_t> likely;             // likewise: it may be expected to touch
  // Likewise, of those that are arranged:
  kernels::AlignedVector<simd::TouchBlock> touches;
  std::vector<std::uint16_t> touching;      // in this substep
  std::vector<std::uint16_t> not_by_lanes;  // floats do not hold it

  void clear() {
    list.clear();
    sides.clear();
    turned.clear();
    likely.clear();
    touches.clear();
    touching.clear();
    not_by_lanes.clear();
  }
  void add(const Pair& pair, const std::array<std::uint32_t, 4>& points, kernels::Vector normal,
           double thickness, bool is_under, bool is_likely = true);
  /// Takes those of another list in an order, in which kNoIndex leaves a lane that is not used: its
  /// points are `unmoved`.
  void take(const NearPairs& from, const std::vector<std::uint32_t>& order, std::uint32_t unmoved);
  /// Its place, or size().
  std::size_t find(const Pair& pair) const {
    return static_cast<std::size_t>(std::ranges::find(list.pairs, pair) - list.pairs.begin());
  }
  bool has(std::size_t i, const std::vector<std::uint16_t>& bits) const {
    return (bits[i / kernels::kLanes] >> i % kernels::kLanes & 1) != 0;
  }
  bool is_touching(std::size_t i) const { return has(i, touching); }
  void set_touching(std::size_t i) {
    std::uint16_t& bits = touching[i / kernels::kLanes];
    bits = static_cast<std::uint16_t>(bits | 1u << i % kernels::kLanes);
  }
  /// What its touch has done in the present substep.
  reference::Grip grip(std::size_t i) const;
  void set_grip(std::size_t i, const reference::Grip& grip);
  /// m, along the normal, in this substep.
  double push(std::size_t i) const {
    const reference::Grip done = grip(i);
    return done.pushed + done.came_out;
  }
  void forget_grips(std::size_t block);
  /// Whether one is on the wrong side of the other.
  bool is_under(std::size_t i) const { return (sides[i / kernels::kLanes].used & under(i)) != 0; }
  void set_under(std::size_t i, bool is_under) {
    std::uint32_t& used = sides[i / kernels::kLanes].used;
    used = is_under ? used | under(i) : used & ~under(i);
  }
  /// From the second feature to the first, as last seen there.
  kernels::Vector normal(std::size_t i) const;
  void set_normal(std::size_t i, kernels::Vector normal);
  std::size_t bytes() const;

 private:
  static std::uint32_t under(std::size_t i) {
    return std::uint32_t{1} << (kernels::kLanes + i % kernels::kLanes);
  }
};
using Near = std::array<NearPairs, kPairLists>;

}  // namespace weft
