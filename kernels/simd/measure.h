/// Strain, | |x_a - x_b| - rest | / rest, in double, straight from the positions. Sums are kept in
/// kLanes columns whatever the width of a vector, and added in one order: the result does not
/// depend on the instruction set. Padding has scale 0 and is left out; ropes count their stretch
/// only.
#pragma once

#include <algorithm>

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
  const Doubles rest = load(g.rest_length + c), zero(0.);
  const Doubles stretch = (xsimd::sqrt(dot(d, d)) - rest) / rest;
  const Doubles error = rope ? xsimd::max(stretch, zero) : xsimd::abs(stretch);
  return xsimd::select(load(g.scale + c) > zero, error, zero);
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

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
