/// The arrays that have a row for each row of a block, as the kernels see them: vector by vector.
/// The rows of yarn_data.h have kLanes lanes. The rows here have kFloats lanes, and those of the
/// first kFloats lanes of a block come first:
///
///     | row 0 | row 1 | ... | row n |  row 0 | row 1 | ... | row n |
///       lanes 0 ... kFloats - 1        lanes kFloats ...
///
/// The data of one vector of yarns therefore fills whole cache lines, and no more of them than it
/// needs: with AVX2 the scratch of a hundred rows fits into a first-level cache of 32 KB.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/simd/lanes.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

using kernels::kLanes;

inline std::uint32_t rows_of(const YarnBlock& block) { return block.last - block.first; }
/// The number of lanes that a kernel works on. Where one vector holds all lanes, it is a constant,
/// so that the compiler knows the first lane of each vector.
inline std::uint32_t lanes_of(const YarnBlock& block) {
  return kFloats == kLanes ? kLanes : block.lanes;
}

/// One geometric vector in each lane of a row.
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

/// The rows that belong to the SIMD vector whose first lane is `lane`, of an array with one row for
/// each row of a block.
template <class Row, class Wide>
[[gnu::always_inline]] inline Row* rows_of_vector(Wide* first, std::size_t rows,
                                                  std::uint32_t lane) {
  static_assert(sizeof(Row) * (kLanes / kFloats) == sizeof(Wide));
  return reinterpret_cast<Row*>(first) + rows * (lane / kFloats);
}

/// One row of the linear system (yarn_system.h).
struct SystemRow {
  RowVectors n;
  float m[kFloats], reciprocal[kFloats];  // the factorisation (yarn_elimination.h)
  float lambda[kFloats], residual[kFloats];
  float z[kFloats], p[kFloats], q[kFloats];
};
[[gnu::always_inline]] inline SystemRow* system_of(const Yarns& y, const YarnBlock& block,
                                                   std::uint32_t lane) {
  return rows_of_vector<SystemRow>(y.system + block.first, rows_of(block), lane);
}

/// The directions at the start of the substep, for scheme rattle; null if impulses act along the
/// present ones.
[[gnu::always_inline]] inline RowVectors* start_of(const Yarns& y, const YarnBlock& block,
                                                   std::uint32_t lane) {
  if (y.start == nullptr) return nullptr;
  return rows_of_vector<RowVectors>(y.start + block.first, rows_of(block), lane);
}

/// The packed differences of base positions (yarn_rows.h).
struct BaseStep {
  std::int32_t words[kFloats];
};
[[gnu::always_inline]] inline BaseStep* base_steps_of(const Yarns& y, const YarnBlock& block,
                                                      std::uint32_t lane) {
  return rows_of_vector<BaseStep>(y.base_step + block.first, rows_of(block), lane);
}

/// The data that a sweep keeps of a row between the forward elimination and the back substitution,
/// where y = r b. Only rows that are not in place keep u.
struct ScratchRow {
  RowVectors u, n;
  float m[kFloats], y[kFloats];
};

/// The scratch has one row for each row of the block, and one more for the elements of patches that
/// have no particle.
class Scratch {
 public:
  static constexpr std::size_t kFloatsOfRow = sizeof(ScratchRow) / sizeof(float);

  [[gnu::always_inline]] Scratch(YarnScratch* scratch, const YarnBlock& block)
      : first_(scratch), rows_(rows_of(block) + 1) {}

  /// The rows of the SIMD vector whose first lane is `lane`.
  [[gnu::always_inline]] ScratchRow* of(std::uint32_t lane) const {
    return rows_of_vector<ScratchRow>(first_, rows_, lane);
  }
  /// The number of floats from the rows of one SIMD vector to those of the next, for each lane
  /// between their first lanes.
  [[gnu::always_inline]] std::size_t stride() const { return rows_ * (kFloatsOfRow / kFloats); }

 private:
  YarnScratch* first_;
  std::size_t rows_;
};

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
