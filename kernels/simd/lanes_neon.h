/// Functions that NEON of aarch64 has in its own way; lanes.h says what each one means.
#pragma once

#include "kernels/simd/batches.h"

// xsimd 8.1 divides and takes roots of floats by estimates that it refines; the processor rounds.
template <>
inline xsimd::batch<float, xsimd::neon64>& xsimd::batch<float, xsimd::neon64>::operator/=(
    const batch& other) noexcept {
  return *this = vdivq_f32(*this, other);
}
template <>
inline xsimd::batch<float, xsimd::neon64> xsimd::sqrt(
    const batch<float, xsimd::neon64>& x) noexcept {
  return vsqrtq_f32(x);
}

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

constexpr bool kFuses = true;  // x y + z is rounded once

[[gnu::always_inline]] inline Floats fused(Floats x, Floats y, Floats z) {
  return Floats(vfmaq_f32(z, x, y));
}
[[gnu::always_inline]] inline Floats fused_from(Floats x, Floats y, Floats z) {
  return Floats(vfmsq_f32(z, x, y));
}
[[gnu::always_inline]] inline Doubles fused(Doubles x, Doubles y, Doubles z) {
  return Doubles(vfmaq_f64(z, x, y));
}

[[gnu::always_inline]] inline std::uint32_t bits(FloatMask mask) {
  return vaddvq_u32(vandq_u32(mask, uint32x4_t{1, 2, 4, 8}));
}
[[gnu::always_inline]] inline std::uint32_t count(FloatMask mask) {
  return vaddvq_u32(vshrq_n_u32(mask, 31));
}

[[gnu::always_inline]] inline void store_as_float(float* p, Doubles d) {
  vst1_f32(p, vcvt_f32_f64(d));
}
[[gnu::always_inline]] inline Doubles load_as_double(const float* p) {
  return Doubles(vcvt_f64_f32(vld1_f32(p)));
}
[[gnu::always_inline]] inline Doubles to_float_and_back(Doubles d) {
  return Doubles(vcvt_f64_f32(vcvt_f32_f64(d)));
}
[[gnu::always_inline]] inline Floats narrow(Doubles first, Doubles second) {
  return Floats(vcvt_high_f32_f64(vcvt_f32_f64(first), second));
}
[[gnu::always_inline]] inline Doubles widen_first(Floats f) {
  return Doubles(vcvt_f64_f32(vget_low_f32(f)));
}
[[gnu::always_inline]] inline Doubles widen_second(Floats f) {
  return Doubles(vcvt_high_f64_f32(f));
}

template <class At>
[[gnu::always_inline]] inline Floats load_quads(const float* u, At at) {
  return Floats::load_unaligned(u + at[0]);
}
template <class At>
[[gnu::always_inline]] inline void store_quads(float* u, At at, Floats q) {
  q.store_unaligned(u + at[0]);
}
[[gnu::always_inline]] inline Floats unpack_low(Floats a, Floats b) {
  return Floats(vzip1q_f32(a, b));
}
[[gnu::always_inline]] inline Floats unpack_high(Floats a, Floats b) {
  return Floats(vzip2q_f32(a, b));
}
[[gnu::always_inline]] inline Floats low_pairs(Floats a, Floats b) {
  return Floats(vcombine_f32(vget_low_f32(a), vget_low_f32(b)));
}
[[gnu::always_inline]] inline Floats high_pairs(Floats a, Floats b) {
  return Floats(vcombine_f32(vget_high_f32(a), vget_high_f32(b)));
}

[[gnu::always_inline]] inline Floats in_order(Floats v) { return v; }
[[gnu::always_inline]] inline Floats out_of_order(Floats v) { return v; }

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
