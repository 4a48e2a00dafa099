/// The places of the particles of yarns in memory, and how the rows of a block find them. There are
/// two layouts. The arrays base, u and t of a cloth have the same layout.
///
/// Quads (quads.h) serve any mesh: a row gathers its particles, and scatters them again.
///
/// The woven layout serves sheets. It stores rows of kLanes particles,
///
///     | x x ... x | y y ... y | z z ... z | x x ... x | ...
///
/// block after block of one family, whose yarns are adjacent: these blocks are in place. Where
/// kLanes yarns of another family cross such a block, the particles of each are in one row of
/// memory. These rows are a patch if they hold no particles of other yarns. A transposed patch
/// consists of rows of the other block, so that patches are copied into the scratch and back with a
/// transposition. Elements of the rows of memory that have no particle are 0.
///
///     memory, in place:  k | a b c d |      row k of the block; lanes a, b, c, d
///                          | e f g h |
///     a patch of it:     l | a b c d |  ->  | a e . . |   lane l has its particles a, b, c, d
///                          | e f g h |      | b f . . |
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/simd/transpose.h"
#include "kernels/simd/yarn_arrays.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

inline void prefetch_row(std::uintptr_t row) {
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    __builtin_prefetch(reinterpret_cast<const float*>(row) + axis * kLanes, 1);
  }
}

/// Rows that follow each other at a distance of kRow floats, with kAxis floats from axis to axis.
/// Both are compile-time constants, because the kernels are slower otherwise.
template <std::size_t kRow, std::size_t kAxis>
struct Rows {
  float* first;
  std::size_t stride;  // floats per lane between the first lanes of two SIMD vectors

  [[gnu::always_inline]] float* at(std::uint32_t row, std::uint32_t lane) const {
    return first + row * kRow + lane * stride;
  }
  [[gnu::always_inline]] FloatVector get(std::uint32_t row, std::uint32_t lane) const {
    const float* x = at(row, lane);
    return {load(x), load(x + kAxis), load(x + 2 * kAxis)};
  }
  [[gnu::always_inline]] void put(std::uint32_t row, std::uint32_t lane,
                                  const FloatVector& v) const {
    float* x = at(row, lane);
    v.x.store_unaligned(x);
    v.y.store_unaligned(x + kAxis);
    v.z.store_unaligned(x + 2 * kAxis);
  }
  // Between the elimination and the back substitution the rows stay where they are.
  [[gnu::always_inline]] void keep(std::uint32_t, std::uint32_t, const FloatVector&) const {}
  [[gnu::always_inline]] FloatVector kept(std::uint32_t row, std::uint32_t lane) const {
    return get(row, lane);
  }
  [[gnu::always_inline]] void keep_moved(std::uint32_t row, std::uint32_t lane,
                                         const FloatVector& v) const {
    put(row, lane, v);
  }
  [[gnu::always_inline]] void put_kept(std::uint32_t, std::uint32_t) const {}
};

/// Rows of a block in place: they are rows of memory.
struct RowsInPlace : Rows<kRowFloats, kLanes> {
  std::uint32_t ahead = 0;  // the number of rows to prefetch; 0 if all is in the caches

  void fetch(std::uint32_t) const {}
  void put_back(std::uint32_t) const {}
  /// Prefetches rows some way ahead, also of the next block.
  [[gnu::always_inline]] void fetch_ahead(std::uint32_t row, std::uint32_t,
                                          std::uint32_t lane) const {
    constexpr std::size_t kAhead = 32;
    if (row >= ahead || lane > 0) [[likely]]
      return;
    prefetch_row(reinterpret_cast<std::uintptr_t>(first) +
                 (row + kAhead) * kRowFloats * sizeof(float));
  }
};

/// Rows in the scratch, which are copies of patches of memory.
struct FetchedRows : Rows<Scratch::kFloatsOfRow, kFloats> {
  float* memory;
  const YarnPatch* patches;
  std::uint32_t count;   // the number of patches
  std::uint32_t nobody;  // the row of elements without a particle, behind the last
  bool from_memory;      // the patches are not in the caches
  std::uint32_t ahead;   // the number of rows of the next block's patches to prefetch

  /// Copies all patches into the scratch. Called before the first row of a SIMD vector is read.
  void fetch(std::uint32_t lane) const {
    for (std::uint32_t i = 0; i < count; ++i) {
      prefetch_patch(i, lane);
      fetch_patch(patches[i], lane);
    }
  }
  /// Copies all patches back after the last row was written. Elements without a particle become 0.
  void put_back(std::uint32_t lane) const {
    put(nobody, lane, no_vector());
    for (std::uint32_t i = 0; i < count; ++i) put_patch(patches[i], lane);
  }
  /// Prefetches patches of the next block while this one is being solved.
  [[gnu::always_inline]] void fetch_ahead(std::uint32_t row, std::uint32_t,
                                          std::uint32_t lane) const {
    if (row >= ahead || lane > 0) [[likely]]
      return;
    prefetch_memory(patches[count + row / kLanes], row % kLanes);
  }

 private:
  /// The addresses of vectors: in memory that of each lane, beginning at a column; in the scratch
  /// that of each column, beginning at a lane.
  [[gnu::always_inline]] auto in_memory(const YarnPatch& patch, std::uint32_t lane,
                                        std::uint32_t column) const {
    return [&patch, from = memory + column, lane ](std::uint32_t k) __attribute__((always_inline)) {
      return from + patch.place[lane + k];
    };
  }
  [[gnu::always_inline]] auto in_scratch(const YarnPatch& patch, std::uint32_t lane,
                                         std::uint32_t column) const {
    return [&patch, rows = *this, lane, column ](std::uint32_t i) __attribute__((always_inline)) {
      return rows.at(patch.row[column + i], lane);
    };
  }
  // The address of a row is computed for each patch anew, which is faster than first filling arrays
  // of pointers to all rows.
  void fetch_patch(const YarnPatch& patch, std::uint32_t lane) const {
    if (patch.single) {
      return for_each_float(patch, lane, [](float& row, float& place) { row = place; });
    }
    for (std::uint32_t column = 0; column < patch.columns; column += kFloats) {
      transpose(in_memory(patch, lane, column), kLanes, in_scratch(patch, lane, column), kFloats);
    }
  }
  void put_patch(const YarnPatch& patch, std::uint32_t lane) const {
    if (patch.single) {
      return for_each_float(patch, lane, [](float& row, float& place) { place = row; });
    }
    for (std::uint32_t column = 0; column < patch.columns; column += kFloats) {
      transpose(in_scratch(patch, lane, column), kFloats, in_memory(patch, lane, column), kLanes);
    }
  }
  /// Calls work(float of a single row, its place in memory) for each float.
  template <class Work>
  void for_each_float(const YarnPatch& patch, std::uint32_t lane, Work&& work) const {
    float* row = at(patch.row[0], lane);
    for (std::uint32_t k = 0; k < kFloats; ++k) {
      float* place = memory + patch.place[lane + k];
      for (std::size_t axis = 0; axis < kAxes; ++axis) {
        work(row[axis * kFloats + k], place[axis * kLanes]);
      }
    }
  }
  /// Prefetches the patch that is copied a little later.
  void prefetch_patch(std::uint32_t patch, std::uint32_t lane) const {
    constexpr std::uint32_t kAhead = 2;
    if (!from_memory || patch + kAhead >= count) return;
    for (std::uint32_t k = 0; k < kFloats; ++k) prefetch_memory(patches[patch + kAhead], lane + k);
  }
  void prefetch_memory(const YarnPatch& patch, std::uint32_t lane) const {
    prefetch_row(reinterpret_cast<std::uintptr_t>(memory + patch.place[lane]));
  }
};

/// Rows of a block that are gathered from quads. Gathering is expensive, so that the back
/// substitution takes from the scratch what the elimination has gathered.
struct QuadRows {
  float* u;
  const std::uint32_t* slot;
  Scratch scratch;
  bool from_memory;

  [[gnu::always_inline]] FloatVector get(std::uint32_t row, std::uint32_t lane) const {
    return QuadLanes().get(u, slots(row, lane));
  }
  [[gnu::always_inline]] void put(std::uint32_t row, std::uint32_t lane,
                                  const FloatVector& v) const {
    QuadLanes().put(u, slots(row, lane), v);
  }
  [[gnu::always_inline]] void keep(std::uint32_t row, std::uint32_t lane,
                                   const FloatVector& v) const {
    store(scratch.of(lane)[row].u, v);
  }
  [[gnu::always_inline]] FloatVector kept(std::uint32_t row, std::uint32_t lane) const {
    return load(scratch.of(lane)[row].u);
  }
  [[gnu::always_inline]] void keep_moved(std::uint32_t row, std::uint32_t lane,
                                         const FloatVector& v) const {
    keep(row, lane, v);
  }
  [[gnu::always_inline]] void put_kept(std::uint32_t rows, std::uint32_t lanes) const {
    for (std::uint32_t lane = 0; lane < lanes; lane += kFloats) {
      for (std::uint32_t row = 0; row < rows; ++row) put(row, lane, kept(row, lane));
    }
  }
  // Rows are gathered and scattered one by one.
  void fetch(std::uint32_t) const {}
  void put_back(std::uint32_t) const {}
  /// Prefetches particles of the yarns, whose order in memory no hardware prefetcher recognises.
  [[gnu::always_inline]] void fetch_ahead(std::uint32_t row, std::uint32_t last,
                                          std::uint32_t lane) const {
    constexpr std::uint32_t kAhead = 16;
    if (!from_memory) return;
    const std::uint32_t* slot = slots(std::min(row + kAhead, last), lane);
    for (std::uint32_t k = 0; k < kFloats; ++k) {
      __builtin_prefetch(u + 4 * std::size_t{slot[k]}, 1);
    }
  }

 private:
  [[gnu::always_inline]] const std::uint32_t* slots(std::uint32_t row, std::uint32_t lane) const {
    return slot + std::size_t{row} * kLanes + lane;
  }
};

/// The rows of a block in an array that has the layout of u.
inline RowsInPlace rows_in_place(const Yarns& y, const YarnBlock& block, float* memory) {
  return {{memory + block.place, 1}, y.from_memory ? rows_of(block) : 0};
}
inline FetchedRows fetched_rows(const Yarns& y, const YarnBlock& block, float* memory,
                                const Scratch& scratch) {
  return {{scratch.of(0)->u.x, scratch.stride()},
          memory,
          y.patch + block.first_patch,
          block.last_patch - block.first_patch,
          rows_of(block),
          y.from_memory,
          y.from_memory ? block.patches_ahead * kLanes : 0};
}

/// Calls work(rows of the block). It must call fetch() before it reads rows of a SIMD vector, and
/// put_back() after it has changed them.
template <class Work>
[[gnu::always_inline]] inline void with_rows(const Yarns& y, const YarnBlock& block, float* u,
                                             YarnScratch* scratch, Work&& work) {
  const Scratch own(scratch, block);
  if (block.access == YarnAccess::quads) {
    work(QuadRows{u, y.slot + std::size_t{block.first} * kLanes, own, y.from_memory});
  } else if (block.access == YarnAccess::in_place) {
    work(rows_in_place(y, block, u));
  } else {
    work(fetched_rows(y, block, u, own));
  }
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
