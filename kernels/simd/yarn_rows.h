/// The rows of a block of yarns (yarns.h): what they are like, and what they remember of their
/// particles' base.
///
/// Positions are base + u, two floats: base is the double position rounded, u begins with what the
/// rounding lost. Differences of neighbours are exact to the last bits of u.
///
/// Base is a whole number of cells: of the largest power of two that is no more than a sixty-fourth
/// of the longest constraint, nor eight times the shortest, which keeps what is left to u as small
/// as what floats round off a difference. Between neighbours base differs by few cells, which rows
/// remember from the first pass over a new base on:
///
///     |  x: 10 bits  |  y: 10 bits  |  z: 10 bits  | 00 |     in each lane
///
/// a quarter of the bytes that it takes to fetch base again. A block in which a difference is
/// larger (a cloth torn apart, constraints that are thousands of times as long as others) fetches
/// it each time: the row of its last particles, which has no next, has the bits of all differences.
#pragma once

#include <cstdint>

#include "kernels/simd/yarn_places.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// What a row is like.
[[gnu::always_inline]] inline const YarnRow& kind_of(const Yarns& y, std::size_t row) {
  return y.kinds[y.kind[row]];
}

/// A whole number n of -512 ... 511 as n + 512, in bits; what is beyond is negative
/// or 1024 and more, infinities and what is no number too.
[[gnu::always_inline]] inline Ints ten_bits(Floats v, Floats factor) {
  const Floats far(0x1.8p23f + 512);  // the next float is 1 away: the last bits count
  const Ints bits = same_bits<Ints>(fused(v, factor, far));
  return bits ^ same_bits<Ints>(Floats(0x1.8p23f));
}
/// Three of them.
[[gnu::always_inline]] inline Ints packed(Ints x, Ints y, Ints z) {
  const Ints signs(static_cast<std::int32_t>(0x80200800));  // n + 512 has the sign bit of n wrong
  return ((x << 22) | (y << 12) | (z << 2)) ^ signs;
}

#if defined(__AVX512F__)
/// The numbers again, times a cell, and u added. A number's bits are put into the middle of the
/// fraction of a power of two, where they count in cells, and that is taken away again, exactly:
///
///     2^11 cell + (n + 512) cell  -  (2^11 + 512) cell  =  n cell
///
/// Conversions and most of the shifts would be work for the units that add. Without instructions
/// that take three operands, and registers for the constants, these are faster all the same.
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

/// remembered: rows have its difference to that of the next. fetched: it is read, and then
/// remembered.
enum class Base : std::uint8_t { remembered, fetched };

/// Rows of the base, of the kind that those of u are. Where it is remembered nobody looks at them.
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

/// Rows of both, before the first of a vector is wanted.
template <Base kBase, class At>
[[gnu::always_inline]] inline void fetch(const At& at, const At& base, std::uint32_t lane) {
  at.fetch(lane);
  if constexpr (kBase == Base::fetched) base.fetch(lane);
}

/// The base, from row to row.
template <Base kBase, class At>
struct BaseDown {
  const Yarns& y;
  At at;  // base; not looked at where it is remembered
  BaseStep* steps;
  std::uint32_t lane;
  FloatVector here = no_vector();
  Ints all = Ints(0);  // that has been remembered
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
  /// base + u, from particle k + 1 to particle k; without a constraint base counts for 0.
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
  /// After all but the last row.
  [[gnu::always_inline]] void end(std::uint32_t last) {
    if constexpr (kBase == Base::remembered) return;
    all.store_unaligned(steps[last].words);
  }

 private:
  /// What a way down reads once is not to push displacements out of the caches.
  [[gnu::always_inline]] void fetch_ahead(std::uint32_t row) const {
    constexpr std::uintptr_t kAhead = 32 * sizeof(BaseStep);
    constexpr int kToRead = 0, kNotAgain = 0;
    const auto here = reinterpret_cast<std::uintptr_t>(steps + row);
    __builtin_prefetch(reinterpret_cast<const void*>(here + kAhead), kToRead, kNotAgain);
  }
};

/// Whether rows remember the present base.
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
