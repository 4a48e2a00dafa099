/// Functions that SSE2 has in its own way; lanes.h says what each one means.
#pragma once

#include "kernels/simd/batches.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

constexpr bool kFuses = false;  // x y + z is rounded once

[[gnu::always_inline]] inline Floats fused(Floats x, Floats y, Floats z) { return x * y + z; }
[[gnu::always_inline]] inline Floats fused_from(Floats x, Floats y, Floats z) { return z - x * y; }
[[gnu::always_inline]] inline Doubles fused(Doubles x, Doubles y, Doubles z) { return x * y + z; }

[[gnu::always_inline]] inline std::uint32_t bits(FloatMask mask) {
  return static_cast<std::uint32_t>(_mm_movemask_ps(mask));
}
[[gnu::always_inline]] inline std::uint32_t count(FloatMask mask) {
  return (0x4332322132212110u >> (4 * bits(mask))) & 15;  // there is no popcnt
}

[[gnu::always_inline]] inline void store_as_float(float* p, Doubles d) {
  _mm_storel_pi(reinterpret_cast<__m64*>(p), _mm_cvtpd_ps(d));
}
[[gnu::always_inline]] inline Doubles load_as_double(const float* p) {
  return Doubles(_mm_cvtps_pd(_mm_loadl_pi(_mm_setzero_ps(), reinterpret_cast<const __m64*>(p))));
}
[[gnu::always_inline]] inline Doubles to_float_and_back(Doubles d) {
  return Doubles(_mm_cvtps_pd(_mm_cvtpd_ps(d)));
}
[[gnu::always_inline]] inline Floats narrow(Doubles first, Doubles second) {
  return Floats(_mm_movelh_ps(_mm_cvtpd_ps(first), _mm_cvtpd_ps(second)));
}
[[gnu::always_inline]] inline Doubles widen_first(Floats f) { return Doubles(_mm_cvtps_pd(f)); }
[[gnu::always_inline]] inline Doubles widen_second(Floats f) {
  return Doubles(_mm_cvtps_pd(_mm_movehl_ps(f, f)));
}

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

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
