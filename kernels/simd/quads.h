/// Displacements in quads, | x y z - |, one slot each (table.h): a scattered slot is one load of 16
/// bytes, and four of them make vectors by a transpose of 4 x 4. In vectors of more than four lanes
/// that happens in each 128 bits on their own, so the register that holds lane 0 also holds lanes
/// 4, 8 and 12:
///
///     q0 = | slot 0 | slot 4 | ...        x = | x0 x1 x2 x3 | x4 x5 x6 x7 | ...
///     q1 = | slot 1 | slot 5 | ...   ->   y = | y0 y1 y2 y3 | y4 y5 y6 y7 | ...
///     q2 = | slot 2 | slot 6 | ...        z = | z0 z1 z2 z3 | z4 z5 z6 z7 | ...
///     q3 = | slot 3 | slot 7 | ...
#pragma once

#include "kernels/simd/lanes.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

#if defined(__AVX512F__)

[[gnu::always_inline]] inline Floats load_quads(const float* u, const std::uint32_t* slot) {
  const auto quad = [&](std::uint32_t k) { return _mm_load_ps(u + 4 * std::size_t{slot[k]}); };
  const __m256 low = _mm256_insertf128_ps(_mm256_castps128_ps256(quad(0)), quad(4), 1);
  const __m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(quad(8)), quad(12), 1);
  return Floats(_mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1));
}
[[gnu::always_inline]] inline void store_quads(float* u, const std::uint32_t* slot, Floats q) {
  _mm_store_ps(u + 4 * std::size_t{slot[0]}, _mm512_castps512_ps128(q));
  _mm_store_ps(u + 4 * std::size_t{slot[4]}, _mm512_extractf32x4_ps(q, 1));
  _mm_store_ps(u + 4 * std::size_t{slot[8]}, _mm512_extractf32x4_ps(q, 2));
  _mm_store_ps(u + 4 * std::size_t{slot[12]}, _mm512_extractf32x4_ps(q, 3));
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

#elif defined(__AVX2__)

[[gnu::always_inline]] inline Floats load_quads(const float* u, const std::uint32_t* slot) {
  const auto quad = [&](std::uint32_t k) { return _mm_load_ps(u + 4 * std::size_t{slot[k]}); };
  return Floats(_mm256_insertf128_ps(_mm256_castps128_ps256(quad(0)), quad(4), 1));
}
[[gnu::always_inline]] inline void store_quads(float* u, const std::uint32_t* slot, Floats q) {
  _mm_store_ps(u + 4 * std::size_t{slot[0]}, _mm256_castps256_ps128(q));
  _mm_store_ps(u + 4 * std::size_t{slot[4]}, _mm256_extractf128_ps(q, 1));
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

#else

[[gnu::always_inline]] inline Floats load_quads(const float* u, const std::uint32_t* slot) {
  return Floats(_mm_load_ps(u + 4 * std::size_t{slot[0]}));
}
[[gnu::always_inline]] inline void store_quads(float* u, const std::uint32_t* slot, Floats q) {
  _mm_store_ps(u + 4 * std::size_t{slot[0]}, q);
}
[[gnu::always_inline]] inline Floats unpack_low(Floats a, Floats b) {
  return Floats(_mm_unpacklo_ps(a, b));
}
[[gnu::always_inline]] inline Floats unpack_high(Floats a, Floats b) {
  return Floats(_mm_unpackhi_ps(a, b));
}
[[gnu::always_inline]] inline Floats low_pairs(Floats a, Floats b) {
  return Floats(_mm_shuffle_ps(a, b, 0x44));
}
[[gnu::always_inline]] inline Floats high_pairs(Floats a, Floats b) {
  return Floats(_mm_shuffle_ps(a, b, 0xee));
}

#endif

/// Displacements of scattered slots, in quads, brought side by side.
struct QuadLanes {
  [[gnu::always_inline]] FloatVector get(const Displacements& u, const std::uint32_t* slot) {
    return get(u.x, slot);
  }
  [[gnu::always_inline]] FloatVector get(const float* u, const std::uint32_t* slot) {
    const Floats q0 = load_quads(u, slot), q1 = load_quads(u, slot + 1);
    const Floats q2 = load_quads(u, slot + 2), q3 = load_quads(u, slot + 3);
    const Floats xy01 = unpack_low(q0, q1), xy23 = unpack_low(q2, q3);
    const Floats z01 = unpack_high(q0, q1), z23 = unpack_high(q2, q3);
    return {low_pairs(xy01, xy23), high_pairs(xy01, xy23), low_pairs(z01, z23)};
  }
  [[gnu::always_inline]] void put(const Displacements& u, const std::uint32_t* slot,
                                  const FloatVector& v) {
    const Floats none(0.f);
    const Floats xy01 = unpack_low(v.x, v.y), xy23 = unpack_high(v.x, v.y);
    const Floats z01 = unpack_low(v.z, none), z23 = unpack_high(v.z, none);
    store_quads(u.x, slot, low_pairs(xy01, z01));
    store_quads(u.x, slot + 1, high_pairs(xy01, z01));
    store_quads(u.x, slot + 2, low_pairs(xy23, z23));
    store_quads(u.x, slot + 3, high_pairs(xy23, z23));
  }
};

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
