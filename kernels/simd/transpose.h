/// Transposes of kFloats vectors of kFloats floats, from memory to memory.
#pragma once

#include <cstddef>

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

constexpr std::size_t kAxes = 3;

/// The pointer in a register of its own: GCC 12 would rather add up its parts anew for each vector.
template <class T>
[[gnu::always_inline]] inline T* held(T* pointer) {
  asm("" : "+r"(pointer));
  return pointer;
}

/// to(i)[k] = from(k)[i], for kFloats of each; and of the other two axes, so many floats behind.
/// from, to: where a row begins.
template <class From, class To>
[[gnu::always_inline]] inline void transpose(const From& from, std::size_t from_axis, const To& to,
                                             std::size_t to_axis) {
#if defined(__AVX512F__)
  // Fours of vectors first; then what is left is a transpose of 4 x 4 quarters.
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    Floats v[4][4];
    for (std::uint32_t i = 0; i < 4; ++i) {
      for (std::uint32_t k = 0; k < 4; ++k) v[i][k] = load(from(4 * i + k) + axis * from_axis);
      transpose_fours(v[i]);
    }
    for (std::uint32_t k = 0; k < 4; ++k) {
      const __m512 even01 = _mm512_shuffle_f32x4(v[0][k], v[1][k], 0x88);
      const __m512 odd01 = _mm512_shuffle_f32x4(v[0][k], v[1][k], 0xdd);
      const __m512 even23 = _mm512_shuffle_f32x4(v[2][k], v[3][k], 0x88);
      const __m512 odd23 = _mm512_shuffle_f32x4(v[2][k], v[3][k], 0xdd);
      const std::size_t x = axis * to_axis;
      _mm512_storeu_ps(to(k) + x, _mm512_shuffle_f32x4(even01, even23, 0x88));
      _mm512_storeu_ps(to(4 + k) + x, _mm512_shuffle_f32x4(odd01, odd23, 0x88));
      _mm512_storeu_ps(to(8 + k) + x, _mm512_shuffle_f32x4(even01, even23, 0xdd));
      _mm512_storeu_ps(to(12 + k) + x, _mm512_shuffle_f32x4(odd01, odd23, 0xdd));
    }
  }
#elif defined(__AVX2__)
  const float* rows[8];
  for (std::uint32_t k = 0; k < 8; ++k) rows[k] = held(from(k));
  for (std::uint32_t half = 0; half < 8; half += 4) {
    float* columns[4];
    for (std::uint32_t i = 0; i < 4; ++i) columns[i] = held(to(half + i));
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      Floats v[4];
      for (std::uint32_t k = 0; k < 4; ++k) {
        const __m128 first = _mm_loadu_ps(rows[k] + (axis * from_axis + half));
        const __m128 second = _mm_loadu_ps(rows[4 + k] + (axis * from_axis + half));
        v[k] = Floats(_mm256_insertf128_ps(_mm256_castps128_ps256(first), second, 1));
      }
      transpose_fours(v);
      for (std::uint32_t i = 0; i < 4; ++i) v[i].store_unaligned(columns[i] + axis * to_axis);
    }
  }
#else
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    Floats v[4];
    for (std::uint32_t k = 0; k < 4; ++k) v[k] = load(from(k) + axis * from_axis);
    transpose_fours(v);
    for (std::uint32_t i = 0; i < 4; ++i) v[i].store_unaligned(to(i) + axis * to_axis);
  }
#endif
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
