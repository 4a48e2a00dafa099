/// Transposes of kFloats vectors of kFloats floats, from memory to memory.
#pragma once

#include "kernels/simd/quads.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// In each 128 bits a transpose of 4 x 4.
[[gnu::always_inline]] inline void transpose_fours(Floats (&v)[4]) {
  const Floats low01 = unpack_low(v[0], v[1]), low23 = unpack_low(v[2], v[3]);
  const Floats high01 = unpack_high(v[0], v[1]), high23 = unpack_high(v[2], v[3]);
  v[0] = low_pairs(low01, low23);
  v[1] = high_pairs(low01, low23);
  v[2] = low_pairs(high01, high23);
  v[3] = high_pairs(high01, high23);
}

/// to(i)[k] = from(k)[i], for kFloats of each. from, to: where a row begins.
template <class From, class To>
[[gnu::always_inline]] inline void transpose(const From& from, const To& to) {
#if defined(__AVX512F__)
  // Fours of vectors first; then what is left is a transpose of 4 x 4 quarters.
  Floats v[4][4];
  for (std::uint32_t i = 0; i < 4; ++i) {
    for (std::uint32_t k = 0; k < 4; ++k) v[i][k] = load(from(4 * i + k));
    transpose_fours(v[i]);
  }
  for (std::uint32_t k = 0; k < 4; ++k) {
    const __m512 even01 = _mm512_shuffle_f32x4(v[0][k], v[1][k], 0x88);
    const __m512 odd01 = _mm512_shuffle_f32x4(v[0][k], v[1][k], 0xdd);
    const __m512 even23 = _mm512_shuffle_f32x4(v[2][k], v[3][k], 0x88);
    const __m512 odd23 = _mm512_shuffle_f32x4(v[2][k], v[3][k], 0xdd);
    _mm512_storeu_ps(to(k), _mm512_shuffle_f32x4(even01, even23, 0x88));
    _mm512_storeu_ps(to(4 + k), _mm512_shuffle_f32x4(odd01, odd23, 0x88));
    _mm512_storeu_ps(to(8 + k), _mm512_shuffle_f32x4(even01, even23, 0xdd));
    _mm512_storeu_ps(to(12 + k), _mm512_shuffle_f32x4(odd01, odd23, 0xdd));
  }
#elif defined(__AVX2__)
  for (std::uint32_t half = 0; half < 8; half += 4) {
    Floats v[4];
    for (std::uint32_t k = 0; k < 4; ++k) {
      const __m128 first = _mm_loadu_ps(from(k) + half), second = _mm_loadu_ps(from(4 + k) + half);
      v[k] = Floats(_mm256_insertf128_ps(_mm256_castps128_ps256(first), second, 1));
    }
    transpose_fours(v);
    for (std::uint32_t k = 0; k < 4; ++k) v[k].store_unaligned(to(half + k));
  }
#else
  Floats v[4] = {load(from(0)), load(from(1)), load(from(2)), load(from(3))};
  transpose_fours(v);
  for (std::uint32_t k = 0; k < 4; ++k) v[k].store_unaligned(to(k));
#endif
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
