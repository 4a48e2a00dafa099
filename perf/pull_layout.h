/// The tables of the anticipating form (kernels/simd/anticipate.h): from which constraints each
/// constraint pulls, and with which weight.
///
/// In a run the neighbours of neighbouring lanes are mostly neighbours too. So the pulls of a block
/// of kLanes constraints are grouped by their distance, constraint slot minus constraint slot: one
/// pull per distance that occurs, with weight 0 where a lane has no neighbour there. Inside a grid
/// a block has six; at the seams of runs a few more.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/ordering/ordering.h"
#include "kernels/simd/table.h"

namespace weft::perf {

class PullLayout {
 public:
  /// The blocks hold the gains; one for every kLanes constraint slots of the ordering. Where
  /// products are made of them there must be a block before the first and one behind the last.
  PullLayout(const Ordering& ordering, std::span<const simd::ConstraintBlock> blocks);
  simd::Anticipation anticipation(float threshold);
  std::size_t pulls() const { return first_pull_.back(); }

 private:
  void add_run_block(std::uint32_t block);
  void add_singles_block(std::uint32_t block);

  struct Neighbour {
    std::uint32_t constraint;
    float weight;
  };
  std::vector<std::vector<Neighbour>> neighbours_;  // per constraint slot; while building

  std::vector<std::uint32_t> first_pull_;
  std::vector<std::int32_t> from_run_, from_singles_;
  kernels::AlignedVector<float> weight_, product_;
  kernels::AlignedVector<float> error_, change_, sum_;
  bool has_singles_ = false;
};

}  // namespace weft::perf
