/// Functions that AVX2 with FMA has in its own way; lanes.h says what each one means.
#pragma once

#include "kernels/simd/batches.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

constexpr bool kFuses = true;  // x y + z is rounded once

[[gnu::always_inline]] inline Floats fused(Floats x, Floats y, Floats z) {
  return xsimd::fma(x, y, z);
}
[[gnu::always_inline]] inline Floats fused_from(Floats x, Floats y, Floats z) {
  return xsimd::fnma(x, y, z);
}
[[gnu::always_inline]] inline Doubles fused(Doubles x, Doubles y, Doubles z) {
  return xsimd::fma(x, y, z);
}

[[gnu::always_inline]] inline std::uint32_t bits(FloatMask mask) {
  return static_cast<std::uint32_t>(_mm256_movemask_ps(mask));
}
[[gnu::always_inline]] inline std::uint32_t count(FloatMask mask) {
  return static_cast<std::uint32_t>(__builtin_popcount(bits(mask)));
}

[[gnu::always_inline]] inline void store_as_float(float* p, Doubles d) {
  _mm_storeu_ps(p, _mm256_cvtpd_ps(d));
}
[[gnu::always_inline]] inline Doubles load_as_double(const float* p) {
  return Doubles(_mm256_cvtps_pd(_mm_loadu_ps(p)));
}
[[gnu::always_inline]] inline Doubles to_float_and_back(Doubles d) {
  return Doubles(_mm256_cvtps_pd(_mm256_cvtpd_ps(d)));
}
[[gnu::always_inline]] inline Floats narrow(Doubles first, Doubles second) {
  return Floats(_mm256_set_m128(_mm256_cvtpd_ps(second), _mm256_cvtpd_ps(first)));
}
[[gnu::always_inline]] inline Doubles widen_first(Floats f) {
  return Doubles(_mm256_cvtps_pd(_mm256_castps256_ps128(f)));
}
[[gnu::always_inline]] inline Doubles widen_second(Floats f) {
  return Doubles(_mm256_cvtps_pd(_mm256_extractf128_ps(f, 1)));
}

template <class At>
[[gnu::always_inline]] inline Floats load_quads(const float* u, At at) {
  const auto quad = [&](std::uint32_t k) { return _mm_load_ps(u + at[k]); };
  return Floats(_mm256_insertf128_ps(_mm256_castps128_ps256(quad(0)), quad(4), 1));
}
template <class At>
[[gnu::always_inline]] inline void store_quads(float* u, At at, Floats q) {
  _mm_store_ps(u + at[0], _mm256_castps256_ps128(q));
  _mm_store_ps(u + at[4], _mm256_extractf128_ps(q, 1));
}
[[gnu::always_inline]] inline Floats unpack_low(Floats a, Floats b) {
  return Floats(_mm256_unpacklo_ps(a, b));
}
[[gnu::always_inline]] inline Floats unpack_high(Floats a, Floats b) {
  return Floats(_mm256_unpackhi_ps(a, b));
}
[[gnu::always_inline]] inline Floats low_pairs(Floats a, Floats b) {
  return Floats(_mm256_shuffle_ps(a, b, 0x44));
}
[[gnu::always_inline]] inline Floats high_pairs(Floats a, Floats b) {
  return Floats(_mm256_shuffle_ps(a, b, 0xee));
}

/// Lanes 0, 2, 4, 6, 1, 3, 5, 7 put in order, and back.
[[gnu::always_inline]] inline Floats in_order(Floats v) {
  return Floats(_mm256_permutevar8x32_ps(v, _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7)));
}
[[gnu::always_inline]] inline Floats out_of_order(Floats v) {
  return Floats(_mm256_permutevar8x32_ps(v, _mm256_setr_epi32(0, 2, 4, 6, 1, 3, 5, 7)));
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
