/// Bending elements in the order in which small steps add up their pulls: batch by batch, those of
/// three particles first. No two elements of a batch share a particle.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/solvers/small_steps/bending_rows.h"
#include "engine/solvers/small_steps/creases.h"
#include "kernels/simd/table.h"

namespace weft {

class Model;

/// Blocks first ... last - 1.
struct BendingBatch {
  std::uint32_t first = 0, last = 0;
  bool four = false;  // particles, not three
};

struct BendingLayout {
  std::vector<simd::BendingBlock> blocks;
  std::vector<std::uint32_t> element;  // per block and lane: in Model::bending, or kNoIndex
  std::vector<BendingBatch> batches;
  std::vector<std::optional<std::uint32_t>> beside;  // per element in Model::bending: a slot
  std::vector<simd::BendingFolds> folds;  // per block; empty: no hinge is folded at rest, or yields
  std::vector<std::uint32_t> place;       // per element, if some yield: index in `element`
  CreaseLayout creases;
  BendingRows rows;
  bool curved = false;  // a rest is not 0

  bool empty() const { return blocks.empty(); }
  std::size_t bytes() const;
};

BendingLayout make_bending_layout(const Model& model);

}  // namespace weft
