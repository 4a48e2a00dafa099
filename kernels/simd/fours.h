/// Four doubles: a particle's vector in double, | x y z - |. On AVX2 and AVX-512 one register, else
/// two.
#pragma once

#include "kernels/simd/lanes.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

#if defined(__AVX2__)
struct Four {
  __m256d v;
  [[gnu::always_inline]] static Four all(double a) { return {_mm256_set1_pd(a)}; }
  [[gnu::always_inline]] static Four load(const double* p) { return {_mm256_load_pd(p)}; }
  [[gnu::always_inline]] void store(double* p) const { _mm256_store_pd(p, v); }
};
[[gnu::always_inline]] inline Four operator+(Four a, Four b) { return {_mm256_add_pd(a.v, b.v)}; }
[[gnu::always_inline]] inline Four operator*(Four a, Four b) { return {_mm256_mul_pd(a.v, b.v)}; }
/// x y + z
[[gnu::always_inline]] inline Four fused(Four x, Four y, Four z) {
  return {_mm256_fmadd_pd(x.v, y.v, z.v)};
}
/// z - x y
[[gnu::always_inline]] inline Four fused_from(Four x, Four y, Four z) {
  return {_mm256_fnmadd_pd(x.v, y.v, z.v)};
}
#else
static_assert(kDoubles == 2);
struct Four {
  Doubles low, high;
  [[gnu::always_inline]] static Four all(double a) { return {Doubles(a), Doubles(a)}; }
  [[gnu::always_inline]] static Four load(const double* p) {
    return {Doubles::load_aligned(p), Doubles::load_aligned(p + 2)};
  }
  [[gnu::always_inline]] void store(double* p) const {
    low.store_aligned(p);
    high.store_aligned(p + 2);
  }
};
[[gnu::always_inline]] inline Four operator+(Four a, Four b) {
  return {a.low + b.low, a.high + b.high};
}
[[gnu::always_inline]] inline Four operator*(Four a, Four b) {
  return {a.low * b.low, a.high * b.high};
}
[[gnu::always_inline]] inline Four fused(Four x, Four y, Four z) {
  return {fused(x.low, y.low, z.low), fused(x.high, y.high, z.high)};
}
[[gnu::always_inline]] inline Four fused_from(Four x, Four y, Four z) {
  return {fused(-x.low, y.low, z.low), fused(-x.high, y.high, z.high)};
}
#endif

/// In one order, whatever the registers.
[[gnu::always_inline]] inline double sum(Four a) {
  alignas(32) double of[4];
  a.store(of);
  return (of[0] + of[1]) + (of[2] + of[3]);
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
