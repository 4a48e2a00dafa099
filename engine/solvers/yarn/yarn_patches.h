/// Patches: the pieces into which blocks are cut whose yarns are not in place (yarn_memory_rows.h).
///
/// A yarn along the rows of a sheet passes through the lanes of the rows of memory, two slots apart
/// or in another order; the column of each particle tells which one it is. The rows of a block
/// whose lanes lie in the same rows of memory make a patch, which a kernel transposes as a whole:
/// it has one row of the block for each column. All other rows are single: each lane is gathered by
/// itself.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/solvers/yarn/yarn_memory_rows.h"

namespace weft {

class YarnPatches {
 public:
  YarnPatches(const SlotRows& slots, const YarnHome& home);

  /// Cuts the rows of a block into patches. Adds a row of memory without particles, for the padding
  /// lanes of the block.
  simd::YarnBlock cut(simd::YarnBlock block);

  std::size_t rows_of_memory() const { return rows_; }
  /// The share of all cut rows that are in whole patches.
  double share_whole() const;
  std::vector<simd::YarnPatch> patches() && { return std::move(patches_); }

 private:
  using Memory = std::array<std::uint32_t, kernels::kLanes>;   // per lane: its row of memory
  using Columns = std::array<std::uint32_t, kernels::kLanes>;  // per column: the row of the block

  /// Where the particles of a row of a block are: per lane the row of memory, and the column if all
  /// lanes have the same.
  struct Stand {
    Memory memory{};
    std::uint32_t column = kNoIndex;
  };
  Stand stand(SlotRows::Slots slots, std::uint32_t nobody) const;
  bool is_whole(const Memory& memory, const Columns& columns, std::uint32_t nobody) const;
  void add_whole(const Memory& memory, const Columns& columns, std::uint32_t rows);
  void add_single(const simd::YarnBlock& block, std::uint32_t row, std::uint32_t nobody);

  SlotRows slots_;
  const std::vector<std::uint32_t>& place_;  // per slot (YarnPlaces)
  std::size_t rows_;                         // the number of rows of memory
  std::vector<std::uint32_t> particles_;     // per row of memory: a bit for each particle
  std::vector<simd::YarnPatch> patches_;
  std::size_t cut_ = 0, whole_ = 0;  // rows of blocks: all, and those in whole patches
};

}  // namespace weft
