/// Where the particles of yarns stand in memory, and how the rows of a block find them. There are
/// two layouts; base, u and t of a cloth have the same.
///
/// Quads (quads.h), for any mesh: a row gathers its particles, and scatters them again.
///
/// Woven, for sheets: in rows of kLanes particles,
///
///     | x x ... x | y y ... y | z z ... z | x x ... x | ...
///
/// block after block of one family, whose yarns stand side by side: its blocks are in place. Where
/// kLanes yarns of another family cross one of these blocks, each has particles in a row of memory;
/// where it crosses nobody else's, these rows are a patch. Transposed, it is rows of the other
/// block: patches are fetched into the scratch, and put back from there. What rows of memory have
/// besides particles is nobody's, and 0.
///
///     memory, in place:  k | a b c d |      row k of the block; lanes a, b, c, d
///                          | e f g h |
///     a patch of it:     l | a b c d |  ->  | a e . . |   lane l has its particles a, b, c, d
///                          | e f g h |      | b f . . |
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/simd/quads.h"
#include "kernels/simd/transpose.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

using kernels::kLanes;

/// What will be wanted from memory: in place, the rows behind each of `rows` rows; or the patches
/// of the next block.
struct Ahead {
  std::uint32_t rows = 0;  // of memory; 0: it is in the caches
  const YarnPatch* patch = nullptr;
  const float* memory = nullptr;
};

inline void prefetch_row(std::uintptr_t row) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    __builtin_prefetch(reinterpret_cast<const float*>(row) + axis * kLanes, 1);
  }
}

/// Rows of a block that stand one behind the other: in place, or in the scratch.
struct Rows {
  float* first;
  std::size_t stride;  // floats
  Ahead ahead = {};

  [[gnu::always_inline]] FloatVector get(std::uint32_t row, std::uint32_t lane) const {
    const float* x = at(row, lane);
    return {load(x), load(x + kLanes), load(x + 2 * kLanes)};
  }
  [[gnu::always_inline]] void put(std::uint32_t row, std::uint32_t lane,
                                  const FloatVector& v) const {
    float* x = at(row, lane);
    v.x.store_unaligned(x);
    v.y.store_unaligned(x + kLanes);
    v.z.store_unaligned(x + 2 * kLanes);
  }
  // Between a way down and a way up they stay where they are.
  [[gnu::always_inline]] void keep(std::uint32_t, std::uint32_t, const FloatVector&) const {}
  [[gnu::always_inline]] FloatVector kept(std::uint32_t row, std::uint32_t lane) const {
    return get(row, lane);
  }
  [[gnu::always_inline]] void keep_moved(std::uint32_t row, std::uint32_t lane,
                                         const FloatVector& v) const {
    put(row, lane, v);
  }
  [[gnu::always_inline]] void put_kept(std::uint32_t, std::uint32_t) const {}
  /// What stands in place is fetched some rows ahead, into the next block; the patches of the next
  /// block while there is this one to solve in the scratch.
  [[gnu::always_inline]] void fetch_ahead(std::uint32_t row, std::uint32_t,
                                          std::uint32_t lane) const {
    constexpr std::size_t kAhead = 32;
    if (row >= ahead.rows || lane > 0) [[likely]]
      return;
    if (ahead.patch == nullptr) {
      prefetch_row(reinterpret_cast<std::uintptr_t>(first) +
                   (row + kAhead) * stride * sizeof(float));
    } else {
      prefetch_row(reinterpret_cast<std::uintptr_t>(ahead.memory +
                                                    ahead.patch[row / kLanes].place[row % kLanes]));
    }
  }

 private:
  [[gnu::always_inline]] float* at(std::uint32_t row, std::uint32_t lane) const {
    return first + row * stride + lane;
  }
};

/// Rows of a block gathered from quads. Gathering is dear: what a way down has found, the way up
/// has from the scratch. (Found again: 1.2 times as long on AVX-512 at 40 x 40.)
struct QuadRows {
  float* u;
  const std::uint32_t* slot;
  YarnScratch* scratch;
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
    store(scratch[row].u, lane, v);
  }
  [[gnu::always_inline]] FloatVector kept(std::uint32_t row, std::uint32_t lane) const {
    return load(scratch[row].u, lane);
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
  /// Of a yarn that runs across memory no prefetcher knows.
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

inline std::uint32_t rows_of(const YarnBlock& block) { return block.last - block.first; }
/// Those that a kernel works on. Where one vector has all of them their number, and so which lane
/// is the first of a vector, is known to the compiler: otherwise loops take a tenth longer.
inline std::uint32_t lanes_of(const YarnBlock& block) {
  return kFloats == kLanes ? kLanes : block.lanes;
}

constexpr std::size_t kScratchFloats = sizeof(YarnScratch) / sizeof(float);

/// As many as the block has, and one behind them: for what in patches is nobody's.
[[gnu::always_inline]] inline Rows rows_in(YarnScratch* scratch) {
  return {scratch->u.x, kScratchFloats};
}

/// to(i)[k] = from(k)[i], of each axis; from and to: where a row begins.
template <class From, class To>
[[gnu::always_inline]] inline void transpose_rows(std::uint32_t from_rows, const From& from,
                                                  std::uint32_t to_rows, const To& to) {
  for (std::size_t axis = 0; axis < kRowFloats; axis += kLanes) {
    for (std::uint32_t i = 0; i < to_rows; i += kFloats) {
      for (std::uint32_t k = 0; k < from_rows; k += kFloats) {
        transpose(
            [&](std::uint32_t row)
                __attribute__((always_inline)) { return from(k + row) + (axis + i); },
            [&](std::uint32_t row)
                __attribute__((always_inline)) { return to(i + row) + (axis + k); });
      }
    }
  }
}

/// Where a row begins is computed for each vector anew: from arrays of pointers, filled first,
/// transposing took 1.8 times as long.
inline void fetch_patch(const YarnPatch& patch, std::uint32_t lanes, const float* u, float* rows) {
  transpose_rows(
      lanes, [&](std::uint32_t k) __attribute__((always_inline)) { return u + patch.place[k]; },
      kLanes,
      [&](std::uint32_t i)
          __attribute__((always_inline)) { return rows + patch.row[i] * kScratchFloats; });
}
inline void put_patch(const YarnPatch& patch, std::uint32_t lanes, float* u, const float* rows) {
  transpose_rows(
      kLanes,
      [&](std::uint32_t i)
          __attribute__((always_inline)) { return rows + patch.row[i] * kScratchFloats; },
      lanes, [&](std::uint32_t k) __attribute__((always_inline)) { return u + patch.place[k]; });
}

/// work(a float of a single row, and where it stands in memory)
template <class Work>
[[gnu::always_inline]] inline void for_each_float(const YarnPatch& patch, float* u,
                                                  const Rows& rows, Work&& work) {
  float* row = rows.first + patch.row[0] * kScratchFloats;
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    for (std::size_t axis = 0; axis < kRowFloats; axis += kLanes) {
      work(row[axis + lane], u[patch.place[lane] + axis]);
    }
  }
}

/// Memory of patches a little ahead.
inline void prefetch(const Yarns& y, const YarnBlock& block, std::uint32_t patch, const float* u) {
  constexpr std::uint32_t kAhead = 2;
  if (!y.from_memory || patch + kAhead >= block.last_patch) return;
  for (const std::uint32_t place : y.patch[patch + kAhead].place) {
    prefetch_row(reinterpret_cast<std::uintptr_t>(u + place));
  }
}

inline void fetch(const Yarns& y, const YarnBlock& block, float* u, const Rows& rows) {
  for (std::uint32_t i = block.first_patch; i < block.last_patch; ++i) {
    const YarnPatch& patch = y.patch[i];
    prefetch(y, block, i, u);
    if (patch.single) {
      for_each_float(patch, u, rows, [](float& row, float& place) { row = place; });
    } else {
      fetch_patch(patch, lanes_of(block), u, rows.first);
    }
  }
}
/// What is nobody's is put back as 0.
inline void put_back(const Yarns& y, const YarnBlock& block, float* u, const Rows& rows) {
  for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
    rows.put(rows_of(block), lane, no_vector());
  }
  for (std::uint32_t i = block.first_patch; i < block.last_patch; ++i) {
    const YarnPatch& patch = y.patch[i];
    if (patch.single) {
      for_each_float(patch, u, rows, [](float& row, float& place) { place = row; });
    } else {
      put_patch(patch, lanes_of(block), u, rows.first);
    }
  }
}

/// What rows hold is wanted, or written over.
enum class Old : std::uint8_t { wanted, dropped };

/// work(rows of the block), which returns whether it has changed any.
template <Old kOld = Old::wanted, class Work>
[[gnu::always_inline]] inline void with_rows(const Yarns& y, const YarnBlock& block, float* u,
                                             YarnScratch* scratch, Work&& work) {
  if (block.access == YarnAccess::quads) {
    work(QuadRows{u, y.slot + std::size_t{block.first} * kLanes, scratch, y.from_memory});
    return;
  }
  if (block.access == YarnAccess::in_place) {
    work(Rows{u + block.place, kRowFloats, {y.from_memory ? rows_of(block) : 0}});
    return;
  }
  Rows rows = rows_in(scratch);
  if (y.from_memory) rows.ahead = {block.patches_ahead * kLanes, y.patch + block.last_patch, u};
  if (kOld == Old::wanted) fetch(y, block, u, rows);
  if (work(rows)) put_back(y, block, u, rows);
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
