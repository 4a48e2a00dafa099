/// Bending elements in the order in which small steps visit them: class by class, and in each batch
/// by batch, those of three particles first. No two elements of a batch share a particle. A class
/// has elements of like stiffness, which are visited equally often (bending_pace.h): in an
/// irregular mesh the stiffest of all, at a sliver, is a hundred times as stiff as most.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/simd/table.h"

namespace weft {

class Model;

/// Blocks first ... last - 1.
struct BendingBatch {
  std::uint32_t first = 0, last = 0;
  bool four = false;  // particles, not three
};

/// Batches first ... last - 1.
struct BendingClass {
  std::uint32_t first = 0, last = 0;
  double stiffest = 0;  // 1/s^2, the largest of W / compliance (kernels/simd/bending.h)
};

struct BendingLayout {
  std::vector<simd::BendingBlock> blocks;
  std::vector<std::uint32_t> element;  // per block and lane: in Model::bending, or kNoIndex
  std::vector<float> stiffness;        // likewise, 1 / compliance, N/m; padding: 0
  std::vector<BendingBatch> batches;
  std::vector<BendingClass> classes;  // the stiffest first
  bool curved = false;                // a rest is not 0

  bool empty() const { return blocks.empty(); }
  /// Of the lanes of a class.
  std::uint32_t first_lane(const BendingClass& c) const {
    return batches[c.first].first * kernels::kLanes;
  }
  std::uint32_t last_lane(const BendingClass& c) const {
    return batches[c.last - 1].last * kernels::kLanes;
  }
  std::size_t bytes() const;
};

BendingLayout make_bending_layout(const Model& model);

}  // namespace weft
