/// Functions that AVX-512 (F, CD, DQ, BW, VL) has in its own way; lanes.h says what each one means.
#pragma once

#include "kernels/simd/batches.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

constexpr bool kFuses = true;  // x y + z is rounded once

// xsimd 8.1 has no fma for avx512f.
[[gnu::always_inline]] inline Floats fused(Floats x, Floats y, Floats z) {
  return Floats(_mm512_fmadd_ps(x, y, z));
}
[[gnu::always_inline]] inline Floats fused_from(Floats x, Floats y, Floats z) {
  return Floats(_mm512_fnmadd_ps(x, y, z));
}
[[gnu::always_inline]] inline Doubles fused(Doubles x, Doubles y, Doubles z) {
  return Doubles(_mm512_fmadd_pd(x, y, z));
}

[[gnu::always_inline]] inline std::uint32_t bits(FloatMask mask) {
  return static_cast<std::uint32_t>(static_cast<__mmask16>(mask));
}
[[gnu::always_inline]] inline std::uint32_t count(FloatMask mask) {
  return static_cast<std::uint32_t>(__builtin_popcount(bits(mask)));
}

[[gnu::always_inline]] inline void store_as_float(float* p, Doubles d) {
  _mm256_storeu_ps(p, _mm512_cvtpd_ps(d));
}
[[gnu::always_inline]] inline Doubles load_as_double(const float* p) {
  return Doubles(_mm512_cvtps_pd(_mm256_loadu_ps(p)));
}
[[gnu::always_inline]] inline Doubles to_float_and_back(Doubles d) {
  return Doubles(_mm512_cvtps_pd(_mm512_cvtpd_ps(d)));
}
[[gnu::always_inline]] inline Floats narrow(Doubles first, Doubles second) {
  return Floats(_mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(first)),
                                   _mm512_cvtpd_ps(second), 1));
}
[[gnu::always_inline]] inline Doubles widen_first(Floats f) {
  return Doubles(_mm512_cvtps_pd(_mm512_castps512_ps256(f)));
}
[[gnu::always_inline]] inline Doubles widen_second(Floats f) {
  return Doubles(_mm512_cvtps_pd(_mm512_extractf32x8_ps(f, 1)));
}

template <class At>
[[gnu::always_inline]] inline Floats load_quads(const float* u, At at) {
  const auto quad = [&](std::uint32_t k) { return _mm_load_ps(u + at[k]); };
  __m512 v = _mm512_castps128_ps512(quad(0));
  v = _mm512_mask_broadcast_f32x4(v, 0x00f0, quad(4));
  v = _mm512_mask_broadcast_f32x4(v, 0x0f00, quad(8));
  return Floats(_mm512_mask_broadcast_f32x4(v, 0xf000, quad(12)));
}
template <class At>
[[gnu::always_inline]] inline void store_quads(float* u, At at, Floats q) {
  _mm_store_ps(u + at[0], _mm512_castps512_ps128(q));
  _mm_store_ps(u + at[4], _mm512_extractf32x4_ps(q, 1));
  _mm_store_ps(u + at[8], _mm512_extractf32x4_ps(q, 2));
  _mm_store_ps(u + at[12], _mm512_extractf32x4_ps(q, 3));
}
[[gnu::always_inline]] inline Floats unpack_low(Floats a, Floats b) {
  return Floats(_mm512_unpacklo_ps(a, b));
}
[[gnu::always_inline]] inline Floats unpack_high(Floats a, Floats b) {
  return Floats(_mm512_unpackhi_ps(a, b));
}
[[gnu::always_inline]] inline Floats low_pairs(Floats a, Floats b) {
  return Floats(_mm512_shuffle_ps(a, b, 0x44));
}
[[gnu::always_inline]] inline Floats high_pairs(Floats a, Floats b) {
  return Floats(_mm512_shuffle_ps(a, b, 0xee));
}

/// Lanes 0, 4, 8, 12, 1, ... put in order, and back: a transpose of 4 x 4, its own inverse.
[[gnu::always_inline]] inline Floats in_order(Floats v) {
  const __m512i from = _mm512_setr_epi32(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15);
  return Floats(_mm512_permutexvar_ps(from, v));
}
[[gnu::always_inline]] inline Floats out_of_order(Floats v) { return in_order(v); }

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
