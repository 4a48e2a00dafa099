/// Strain, | |x_a - x_b| / rest - 1 |, in double, straight from the positions, as the root of what
/// the squares are to each other: no division. Sums are kept in kLanes columns whatever the width
/// of a vector, and added in one order: the result does not depend on the instruction set. Padding
/// has 1 / rest^2 = 0 and is left out; ropes count their stretch only.
///
/// Where only the largest strain is wanted, the range of (|x_a - x_b| / rest)^2 says it, and
/// no root is taken: 0.7 to 0.85 of the time of strain_run.
#pragma once

#include <algorithm>
#include <limits>

#include "kernels/simd/directions.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

struct StrainColumns {
  alignas(64) double largest[kernels::kLanes] = {};
  alignas(64) double squares[kernels::kLanes] = {};

  [[gnu::always_inline]] void add(std::size_t column, Doubles strain) {
    xsimd::max(load(largest + column), strain).store_aligned(largest + column);
    fused(strain, strain, load(squares + column)).store_aligned(squares + column);
  }
  StrainSums sums() const {
    StrainSums s;
    for (std::uint32_t k = 0; k < kernels::kLanes; ++k) {
      s.largest = std::max(s.largest, largest[k]);
      s.squares += squares[k];
    }
    return s;
  }
};

[[gnu::always_inline]] inline Doubles strain(const Geometry& g, std::size_t c,
                                             const DoubleVector& d, bool rope) {
  const Doubles inverse = load(g.inverse_square + c), zero(0.);
  const Doubles stretch = xsimd::sqrt(inverse * dot(d, d)) - Doubles(1.);
  const Doubles error = rope ? xsimd::max(stretch, zero) : xsimd::abs(stretch);
  return xsimd::select(inverse > zero, error, zero);
}

StrainSums strain_run(const Geometry& g, const Run& run, bool rope) {
  StrainColumns columns;
  for (std::size_t k = 0; k < run.length; k += kDoubles) {
    const DoubleVector d = load(g.x, run.a + k) - load(g.x, run.b + k);
    columns.add(k % kernels::kLanes, strain(g, run.constraint + k, d, rope));
  }
  return columns.sums();
}

StrainSums strain_singles(const Geometry& g, std::uint32_t first, std::uint32_t last, bool rope) {
  StrainColumns columns;
  for (std::size_t c = first; c < last; c += kDoubles) {
    const DoubleVector d = gather(g.x, g.a + c) - gather(g.x, g.b + c);
    columns.add((c - first) % kernels::kLanes, strain(g, c, d, rope));
  }
  return columns.sums();
}

/// Largest and smallest of what was taken; their order does not matter. What is not finite is
/// remembered apart: among lanes a maximum may lose it.
struct StretchLanes {
  Doubles least = Doubles(1.), most = Doubles(1.);
  Doubles poison = Doubles(0.);  // 0, or not a number

  [[gnu::always_inline]] void take(const Geometry& g, std::size_t c, const DoubleVector& d,
                                   bool rope) {
    const Doubles inverse = load(g.inverse_square + c), one(1.);
    const Doubles ratio = xsimd::select(inverse > Doubles(0.), inverse * dot(d, d), one);
    poison = fused(ratio, Doubles(0.), poison);
    most = xsimd::select(ratio > most, ratio, most);
    if (!rope) least = xsimd::select(ratio < least, ratio, least);
  }
  StretchRange range() const {
    alignas(64) double low[kDoubles], high[kDoubles];
    least.store_aligned(low);
    most.store_aligned(high);
    alignas(64) double poisoned[kDoubles];
    poison.store_aligned(poisoned);
    const bool finite = std::ranges::all_of(poisoned, [](double p) { return p == 0; });
    return {*std::ranges::min_element(low),
            finite ? *std::ranges::max_element(high) : std::numeric_limits<double>::infinity()};
  }
};

StretchRange stretch_runs(const Geometry& g, const Run* runs, std::size_t count, bool rope) {
  StretchLanes lanes;
  for (const Run* run = runs; run != runs + count; ++run) {
    for (std::size_t k = 0; k < run->length; k += kDoubles) {
      lanes.take(g, run->constraint + k, load(g.x, run->a + k) - load(g.x, run->b + k), rope);
    }
  }
  return lanes.range();
}

StretchRange stretch_singles(const Geometry& g, std::uint32_t first, std::uint32_t last,
                             bool rope) {
  StretchLanes lanes;
  for (std::size_t c = first; c < last; c += kDoubles) {
    lanes.take(g, c, gather(g.x, g.a + c) - gather(g.x, g.b + c), rope);
  }
  return lanes.range();
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
