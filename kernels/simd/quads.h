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

/// Where quads stand, in floats: of slots, or of places, which are slots times four.
struct QuadSlots {
  const std::uint32_t* slot;
  [[gnu::always_inline]] std::size_t operator[](std::size_t k) const {
    return 4 * std::size_t{slot[k]};
  }
};
struct QuadPlaces {
  const std::uint32_t* place;
  [[gnu::always_inline]] std::size_t operator[](std::size_t k) const { return place[k]; }
};

#if defined(__AVX512F__)

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

#elif defined(__AVX2__)

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

#else

template <class At>
[[gnu::always_inline]] inline Floats load_quads(const float* u, At at) {
  return Floats(_mm_load_ps(u + at[0]));
}
template <class At>
[[gnu::always_inline]] inline void store_quads(float* u, At at, Floats q) {
  _mm_store_ps(u + at[0], q);
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

[[gnu::always_inline]] inline Floats in_order(Floats v) { return v; }
[[gnu::always_inline]] inline Floats out_of_order(Floats v) { return v; }

#endif

template <class At>
[[gnu::always_inline]] inline void subtract_quads(float* u, At at, Floats q) {
  store_quads(u, at, load_quads(u, at) - q);
}

/// Four vectors of quads and the vectors of their components: a transpose of 4 x 4 in each 128
/// bits.
struct Quads {
  Floats q0, q1, q2, q3;
};
[[gnu::always_inline]] inline FloatVector transposed(Floats q0, Floats q1, Floats q2, Floats q3) {
  const Floats xy01 = unpack_low(q0, q1), xy23 = unpack_low(q2, q3);
  const Floats z01 = unpack_high(q0, q1), z23 = unpack_high(q2, q3);
  return {low_pairs(xy01, xy23), high_pairs(xy01, xy23), low_pairs(z01, z23)};
}
[[gnu::always_inline]] inline Quads transposed(const FloatVector& v) {
  const Floats none(0.f);
  const Floats xy01 = unpack_low(v.x, v.y), xy23 = unpack_high(v.x, v.y);
  const Floats z01 = unpack_low(v.z, none), z23 = unpack_high(v.z, none);
  return {low_pairs(xy01, z01), high_pairs(xy01, z01), low_pairs(xy23, z23), high_pairs(xy23, z23)};
}

/// Scattered slots.
struct QuadLanes {
  [[gnu::always_inline]] FloatVector get(const Displacements& u, const std::uint32_t* slot) const {
    return get(u.x, slot);
  }
  [[gnu::always_inline]] FloatVector get(const float* u, const std::uint32_t* slot) const {
    return transposed(load_quads(u, QuadSlots{slot}), load_quads(u, QuadSlots{slot + 1}),
                      load_quads(u, QuadSlots{slot + 2}), load_quads(u, QuadSlots{slot + 3}));
  }
  [[gnu::always_inline]] void put(const Displacements& u, const std::uint32_t* slot,
                                  const FloatVector& v) const {
    put(u.x, slot, v);
  }
  [[gnu::always_inline]] void put(float* u, const std::uint32_t* slot, const FloatVector& v) const {
    Quads q = transposed(v);
    store_quads(u, QuadSlots{slot}, q.q0);
    store_quads(u, QuadSlots{slot + 1}, q.q1);
    store_quads(u, QuadSlots{slot + 2}, q.q2);
    store_quads(u, QuadSlots{slot + 3}, q.q3);
  }
};

/// Quads of kFloats slots in a row.
struct QuadsInRow {
  [[gnu::always_inline]] FloatVector get(const float* u) const {
    FloatVector v =
        transposed(load(u), load(u + kFloats), load(u + 2 * kFloats), load(u + 3 * kFloats));
    return {in_order(v.x), in_order(v.y), in_order(v.z)};
  }
  [[gnu::always_inline]] void put(float* u, const FloatVector& v) const {
    Quads q = transposed({out_of_order(v.x), out_of_order(v.y), out_of_order(v.z)});
    q.q0.store_unaligned(u);
    q.q1.store_unaligned(u + kFloats);
    q.q2.store_unaligned(u + 2 * kFloats);
    q.q3.store_unaligned(u + 3 * kFloats);
  }
};

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
