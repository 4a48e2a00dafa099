/// Patches: what the blocks of yarns that are not in place (yarn_memory_rows.h) are cut into.
///
/// A yarn along the rows of a sheet goes through the lanes of the rows of memory, two slots apart
/// or in another order; it is the columns that say which particle is where. Rows of a block whose
/// lanes stand in the same rows of memory make a patch, which a kernel transposes whole: the row of
/// the block for each column. Other rows are single: each lane finds its particle by itself.
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

  /// The block, its rows cut. Adds a row to memory that is nobody's, for its padding lanes.
  simd::YarnBlock cut(simd::YarnBlock block);

  std::size_t rows_of_memory() const { return rows_; }
  /// Of the rows that were cut, those in patches that are not single.
  double share_whole() const;
  std::vector<simd::YarnPatch> patches() && { return std::move(patches_); }

 private:
  using Memory = std::array<std::uint32_t, kernels::kLanes>;   // a place per lane: of its row
  using Columns = std::array<std::uint32_t, kernels::kLanes>;  // a row of the block per column

  /// Where the particles of a block's row stand: per lane, the row of memory, and, where it is the
  /// same for all of them, the column.
  struct Stand {
    Memory memory{};
    std::uint32_t column = kNoIndex;
  };
  Stand stand(SlotRows::Slots slots, std::uint32_t nobody) const;
  bool is_whole(const Memory& memory, const Columns& columns, std::uint32_t nobody) const;
  void add_whole(const Memory& memory, const Columns& columns, std::uint32_t rows);
  void add_single(const simd::YarnBlock& block, std::uint32_t row, std::uint32_t nobody);

  SlotRows slots_;
  const std::vector<std::uint32_t>& place_;  // per slot
  std::size_t rows_;                         // of memory
  std::vector<std::uint32_t> particles_;     // per row of memory, a bit for each
  std::vector<simd::YarnPatch> patches_;
  std::size_t cut_ = 0, whole_ = 0;  // rows of blocks
};

}  // namespace weft
