/// From which constraints each constraint pulls in the anticipating form
/// (kernels/simd/anticipate.h): from every other that shares a slot with it. Only distance
/// constraints of the batches pull and are pulled from; ropes, and what is at hubs, are not.
///
/// In a run the neighbours of neighbouring lanes are mostly neighbours too. So the pulls of a block
/// of kLanes constraints are grouped by their distance, constraint slot minus constraint slot: one
/// pull per distance that occurs, with weight 0 where a lane has no neighbour there. Inside a grid
/// a block has six; at the seams of runs a few more.
///
/// A lane without a neighbour reads all the same, and another thread must not be writing there. A
/// thread that sweeps a block has the tiles that it touches to itself, so that far a block may read
/// side by side. Elsewhere, and in singles, a block is scattered: every lane has its own index.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/ordering/ordering.h"
#include "kernels/simd/table.h"

namespace weft {

struct PullLayout {
  /// Which ends meet: that of the constraint that pulls, and that of the one it pulls from.
  enum class Meeting : std::uint8_t { none, a_a, a_b, b_a, b_b };

  std::vector<std::uint32_t> first_pull;   // per block of kLanes constraint slots, and the end
  std::vector<std::int32_t> from_run;      // per pull: constraint slot of lane 0
  std::vector<std::int32_t> from_singles;  // per pull and lane; empty if no block is scattered
  std::vector<Meeting> meetings;           // per pull and lane
  std::vector<std::uint8_t> scattered;     // per block

  std::size_t pulls() const { return from_run.size(); }
  std::size_t blocks() const { return scattered.size(); }
  std::size_t bytes() const;

  /// Per pull and lane, from the gains in the constraints' blocks.
  kernels::AlignedVector<float> weights(std::span<const simd::ConstraintBlock> blocks) const;

  /// visit(first, last, scattered) for the longest stretches of constraint slots first ... last - 1
  /// whose blocks are all scattered, or all not.
  template <class Visit>
  void for_each_stretch(std::uint32_t first, std::uint32_t last, Visit&& visit) const {
    while (first < last) {
      const std::uint8_t kind = scattered[first / kLanes];
      std::uint32_t end = first + kLanes;
      while (end < last && scattered[end / kLanes] == kind) end += kLanes;
      visit(first, end, kind != 0);
      first = end;
    }
  }
};

PullLayout make_pull_layout(const Ordering& ordering);

/// The memory of the anticipating form for a set of constraints.
struct PullMemory {
  explicit PullMemory(const PullLayout& layout);

  kernels::AlignedVector<float> error, change, sum;  // per constraint slot
  kernels::AlignedVector<float> product;             // per pull and lane

  simd::Anticipation view(const PullLayout& layout, const kernels::AlignedVector<float>& weight,
                          float threshold);
  std::size_t bytes() const;
};

}  // namespace weft
