/// The rows of a block of yarns (yarns.h): their kinds, and the packed differences of their base
/// positions.
///
/// A position is the sum base + u of two floats. Base is the rounded double position, and u begins
/// as the rounding error. Differences of neighbours are exact to the last bits of u.
///
/// Base is a multiple of the cell, which is the largest power of two that does not exceed a
/// sixty-fourth of the longest constraint or eight times the shortest. This keeps u as small as the
/// rounding error of a difference. The base positions of neighbours differ by few cells, and the
/// first pass over a new base stores these differences in the rows:
///
///     |  x: 10 bits  |  y: 10 bits  |  z: 10 bits  | 00 |     in each lane
///
/// which takes a quarter of the bytes of fetching base again. A block with larger differences (in a
/// cloth that is torn apart, or with constraints thousands of times as long as others) fetches base
/// each time. The row of its last particles, which has no next row, holds the union of the bits of
/// all differences, and so tells whether they fit.
#pragma once

#include <cstdint>

#include "kernels/simd/yarn_places.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// The kind of a row: lengths and masses.
[[gnu::always_inline]] inline const YarnRow& kind_of(const Yarns& y, std::size_t row) {
  return y.kinds[y.kind[row]];
}

/// The bits of n + 512, where n = v * factor is a whole number from -512 to 511. For any other v,
/// infinities and NaN included, the result is negative or at least 1024.
[[gnu::always_inline]] inline Ints ten_bits(Floats v, Floats factor) {
  const Floats far(0x1.8p23f + 512);  // neighbouring floats differ by 1 here
  const Ints bits = same_bits<Ints>(fused(v, factor, far));
  return bits ^ same_bits<Ints>(Floats(0x1.8p23f));
}
/// Packs three such numbers.
[[gnu::always_inline]] inline Ints packed(Ints x, Ints y, Ints z) {
  // n + 512 has the inverted sign bit of n.
  const Ints signs(static_cast<std::int32_t>(0x80200800));
  return ((x << 22) | (y << 12) | (z << 2)) ^ signs;
}

#if defined(__AVX512F__)
/// Unpacks the numbers, multiplies them by the cell, and adds u. The bits of a number are put into
/// the middle of the fraction of a power of two, where their unit is the cell, and the power of two
/// is subtracted, which is exact:
///
///     2^11 cell + (n + 512) cell  -  (2^11 + 512) cell  =  n cell
///
/// This relieves the units that add, which would have to do conversions and most of the shifts. On
/// processors without three-operand logic and enough registers for the constants, conversions are
/// faster.
struct Unpacking {
  Ints middle = Ints(0x3ff << 12), power;
  Floats taken;

  [[gnu::always_inline]] explicit Unpacking(float cell)
      : power(same_bits<Ints>(Floats(0x1p11f * cell)) ^ Ints(0x200 << 12)),
        taken(0x1.4p11f * cell) {}
  [[gnu::always_inline]] FloatVector plus(const FloatVector& u, Ints v) const {
    return FloatVector{number(v >> 10), number(v), number(v << 10)} + u;
  }

 private:
  [[gnu::always_inline]] Floats number(Ints v) const {
    return same_bits<Floats>((v & middle) ^ power) - taken;
  }
};
#else
struct Unpacking {
  Floats cell;

  [[gnu::always_inline]] explicit Unpacking(float of) : cell(of) {}
  [[gnu::always_inline]] FloatVector plus(const FloatVector& u, Ints v) const {
    FloatVector numbers{xsimd::to_float(v >> 22), xsimd::to_float((v << 10) >> 22),
                        xsimd::to_float((v << 20) >> 22)};
    return fused(cell, numbers, u);
  }
};
#endif

/// Where base comes from. remembered: rows hold its difference to the next row. fetched: base is
/// read, and the differences are stored.
enum class Base : std::uint8_t { remembered, fetched };

/// The rows of base, found in the same way as those of u. They are not read where base is
/// remembered.
inline QuadRows rows_of_base(const Yarns& y, const YarnBlock&, const QuadRows& of_u, YarnScratch*) {
  return {y.base, of_u.slot, of_u.scratch, of_u.from_memory};
}
inline RowsInPlace rows_of_base(const Yarns& y, const YarnBlock& block, const RowsInPlace&,
                                YarnScratch*) {
  return rows_in_place(y, block, y.base);
}
inline FetchedRows rows_of_base(const Yarns& y, const YarnBlock& block, const FetchedRows&,
                                YarnScratch* scratch) {
  return fetched_rows(y, block, y.base, Scratch(scratch + rows_of(block) + 1, block));
}

/// Fetches the rows of u and of base. Called before the first row of a SIMD vector is read.
template <Base kBase, class At>
[[gnu::always_inline]] inline void fetch(const At& at, const At& base, std::uint32_t lane) {
  at.fetch(lane);
  if constexpr (kBase == Base::fetched) base.fetch(lane);
}

/// Follows the base from row to row.
template <Base kBase, class At>
struct BaseDown {
  const Yarns& y;
  At at;  // rows of base; not read where it is remembered
  BaseStep* steps;
  std::uint32_t lane;
  FloatVector here = no_vector();
  Ints all = Ints(0);  // the union of the bits of all differences
  Unpacking unpacking;

  [[gnu::always_inline]] BaseDown(const Yarns& yarns, const YarnBlock& block, At base,
                                  std::uint32_t first_lane)
      : y(yarns),
        at(base),
        steps(base_steps_of(yarns, block, first_lane)),
        lane(first_lane),
        unpacking(yarns.cell) {
    if constexpr (kBase == Base::fetched) here = at.get(0, lane);
  }
  /// The difference of base + u from particle k + 1 to particle k, where u is given as a
  /// difference. In a lane without a constraint base counts as 0.
  [[gnu::always_inline]] FloatVector step(std::uint32_t k, const FloatVector& u, Floats rest) {
    if constexpr (kBase == Base::remembered) {
      if (kFloats == kLanes && y.from_memory) fetch_ahead(k);
      return unpacking.plus(u, Ints::load_unaligned(steps[k].words));
    }
    FloatVector next = at.get(k + 1, lane);
    const Floats none(0.f), per_cell(1 / y.cell);
    auto joins = rest > none;
    FloatVector difference{xsimd::select(joins, here.x - next.x, none),
                           xsimd::select(joins, here.y - next.y, none),
                           xsimd::select(joins, here.z - next.z, none)};
    Ints dx = ten_bits(difference.x, per_cell), dy = ten_bits(difference.y, per_cell);
    const Ints dz = ten_bits(difference.z, per_cell);
    packed(dx, dy, dz).store_unaligned(steps[k].words);
    all = all | dx | dy | dz;
    here = next;
    return difference + u;
  }
  /// Called after all rows but the last.
  [[gnu::always_inline]] void end(std::uint32_t last) {
    if constexpr (kBase == Base::remembered) return;
    all.store_unaligned(steps[last].words);
  }

 private:
  /// Prefetches differences without keeping them in the caches, since they are read once and must
  /// not displace u.
  [[gnu::always_inline]] void fetch_ahead(std::uint32_t row) const {
    constexpr std::uintptr_t kAhead = 32 * sizeof(BaseStep);
    constexpr int kToRead = 0, kNotAgain = 0;
    const auto here = reinterpret_cast<std::uintptr_t>(steps + row);
    __builtin_prefetch(reinterpret_cast<const void*>(here + kAhead), kToRead, kNotAgain);
  }
};

/// Whether the rows hold the differences of the present base.
inline bool remembered(const Yarns& y, const YarnBlock& block) {
  if (y.moved) return false;
  Ints all(0);
  for (std::uint32_t lane = 0; lane < kLanes; lane += kFloats) {
    const BaseStep& of_all = base_steps_of(y, block, lane)[rows_of(block) - 1];
    all = all | Ints::load_unaligned(of_all.words);
  }
  return xsimd::all((all & Ints(~1023)) == Ints(0));
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
