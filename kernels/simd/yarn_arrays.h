/// The arrays that have a row for each row of a block, as the kernels see them: vector by vector. A
/// row of the table (table.h) has kLanes lanes; theirs have kFloats, those of a block's first
/// kFloats lanes first,
///
///     | row 0 | row 1 | ... | row n |  row 0 | row 1 | ... | row n |
///       lanes 0 ... kFloats - 1        lanes kFloats ...
///
/// so that what a vector of yarns needs fills whole cache lines, and half as many: with AVX2 the
/// scratch of a hundred rows fits a first level of 32 KB. (perf/tried.md: a sweep takes 0.8 to 0.9
/// of the time.)
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/simd/lanes.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

using kernels::kLanes;

inline std::uint32_t rows_of(const YarnBlock& block) { return block.last - block.first; }
/// Those that a kernel works on. Where one vector has all of them their number, and so which lane
/// is the first of a vector, is known to the compiler: otherwise loops take a tenth longer.
inline std::uint32_t lanes_of(const YarnBlock& block) {
  return kFloats == kLanes ? kLanes : block.lanes;
}

/// A vector in each lane of a row.
struct RowVectors {
  float x[kFloats], y[kFloats], z[kFloats];
};
[[gnu::always_inline]] inline FloatVector load(const RowVectors& v) {
  return {load(v.x), load(v.y), load(v.z)};
}
[[gnu::always_inline]] inline void store(RowVectors& v, const FloatVector& f) {
  f.x.store_unaligned(v.x);
  f.y.store_unaligned(v.y);
  f.z.store_unaligned(v.z);
}

/// Of an array with a row for each of a block's: those of the vector that begins with a lane.
template <class Row, class Wide>
[[gnu::always_inline]] inline Row* rows_of_vector(Wide* first, std::size_t rows,
                                                  std::uint32_t lane) {
  static_assert(sizeof(Row) * (kLanes / kFloats) == sizeof(Wide));
  return reinterpret_cast<Row*>(first) + rows * (lane / kFloats);
}

/// The row's part of the linear system (yarn_system.h).
struct SystemRow {
  RowVectors n;
  float m[kFloats], reciprocal[kFloats];  // factors
  float lambda[kFloats], residual[kFloats];
  float z[kFloats], p[kFloats], q[kFloats];
};
[[gnu::always_inline]] inline SystemRow* system_of(const Yarns& y, const YarnBlock& block,
                                                   std::uint32_t lane) {
  return rows_of_vector<SystemRow>(y.system + block.first, rows_of(block), lane);
}

/// Scheme rattle's directions; null: present ones.
[[gnu::always_inline]] inline RowVectors* start_of(const Yarns& y, const YarnBlock& block,
                                                   std::uint32_t lane) {
  if (y.start == nullptr) return nullptr;
  return rows_of_vector<RowVectors>(y.start + block.first, rows_of(block), lane);
}

/// What rows remember of the base (yarn_rows.h).
struct BaseStep {
  std::int32_t words[kFloats];
};
[[gnu::always_inline]] inline BaseStep* base_steps_of(const Yarns& y, const YarnBlock& block,
                                                      std::uint32_t lane) {
  return rows_of_vector<BaseStep>(y.base_step + block.first, rows_of(block), lane);
}

/// What a sweep keeps of a row between the way down and the way up; y = r b. u: of rows that do not
/// stand in memory as they are.
struct ScratchRow {
  RowVectors u, n;
  float m[kFloats], y[kFloats];
};

/// As many rows as the block has, and one behind them: for what in patches is nobody's.
class Scratch {
 public:
  static constexpr std::size_t kFloatsOfRow = sizeof(ScratchRow) / sizeof(float);

  [[gnu::always_inline]] Scratch(YarnScratch* scratch, const YarnBlock& block)
      : first_(scratch), rows_(rows_of(block) + 1) {}

  /// Those of the vector that begins with a lane.
  [[gnu::always_inline]] ScratchRow* of(std::uint32_t lane) const {
    return rows_of_vector<ScratchRow>(first_, rows_, lane);
  }
  /// Floats from one lane's to the next's, of lanes that begin a vector.
  [[gnu::always_inline]] std::size_t stride() const { return rows_ * (kFloatsOfRow / kFloats); }

 private:
  YarnScratch* first_;
  std::size_t rows_;
};

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
