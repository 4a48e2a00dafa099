/// Four numbers: a particle's vector, | x y z - |. On AVX2 and AVX-512 one register, else one or
/// two.
#pragma once

#include "kernels/simd/lanes.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

template <class Real>
struct FourOf;

#if defined(__AVX2__)
template <>
struct FourOf<double> {
  __m256d v;
  [[gnu::always_inline]] static FourOf all(double a) { return {_mm256_set1_pd(a)}; }
  [[gnu::always_inline]] static FourOf load(const double* p) { return {_mm256_load_pd(p)}; }
  [[gnu::always_inline]] void store(double* p) const { _mm256_store_pd(p, v); }
};
template <>
struct FourOf<float> {
  __m128 v;
  [[gnu::always_inline]] static FourOf all(float a) { return {_mm_set1_ps(a)}; }
  [[gnu::always_inline]] static FourOf load(const float* p) { return {_mm_load_ps(p)}; }
  [[gnu::always_inline]] void store(float* p) const { _mm_store_ps(p, v); }
};
using FourDoubles = FourOf<double>;
using FourFloats = FourOf<float>;
[[gnu::always_inline]] inline FourDoubles operator+(FourDoubles a, FourDoubles b) {
  return {_mm256_add_pd(a.v, b.v)};
}
[[gnu::always_inline]] inline FourFloats operator+(FourFloats a, FourFloats b) {
  return {_mm_add_ps(a.v, b.v)};
}
[[gnu::always_inline]] inline FourDoubles operator*(FourDoubles a, FourDoubles b) {
  return {_mm256_mul_pd(a.v, b.v)};
}
[[gnu::always_inline]] inline FourFloats operator*(FourFloats a, FourFloats b) {
  return {_mm_mul_ps(a.v, b.v)};
}
/// x y + z
[[gnu::always_inline]] inline FourDoubles fused(FourDoubles x, FourDoubles y, FourDoubles z) {
  return {_mm256_fmadd_pd(x.v, y.v, z.v)};
}
[[gnu::always_inline]] inline FourFloats fused(FourFloats x, FourFloats y, FourFloats z) {
  return {_mm_fmadd_ps(x.v, y.v, z.v)};
}
/// z - x y
[[gnu::always_inline]] inline FourDoubles fused_from(FourDoubles x, FourDoubles y, FourDoubles z) {
  return {_mm256_fnmadd_pd(x.v, y.v, z.v)};
}
[[gnu::always_inline]] inline FourFloats fused_from(FourFloats x, FourFloats y, FourFloats z) {
  return {_mm_fnmadd_ps(x.v, y.v, z.v)};
}
#else
static_assert(kDoubles == 2 && kFloats == 4);
template <>
struct FourOf<double> {
  Doubles low, high;
  [[gnu::always_inline]] static FourOf all(double a) { return {Doubles(a), Doubles(a)}; }
  [[gnu::always_inline]] static FourOf load(const double* p) {
    return {Doubles::load_aligned(p), Doubles::load_aligned(p + 2)};
  }
  [[gnu::always_inline]] void store(double* p) const {
    low.store_aligned(p);
    high.store_aligned(p + 2);
  }
};
template <>
struct FourOf<float> {
  Floats v;
  [[gnu::always_inline]] static FourOf all(float a) { return {Floats(a)}; }
  [[gnu::always_inline]] static FourOf load(const float* p) { return {Floats::load_aligned(p)}; }
  [[gnu::always_inline]] void store(float* p) const { v.store_aligned(p); }
};
using FourDoubles = FourOf<double>;
using FourFloats = FourOf<float>;
[[gnu::always_inline]] inline FourDoubles operator+(FourDoubles a, FourDoubles b) {
  return {a.low + b.low, a.high + b.high};
}
[[gnu::always_inline]] inline FourFloats operator+(FourFloats a, FourFloats b) {
  return {a.v + b.v};
}
[[gnu::always_inline]] inline FourDoubles operator*(FourDoubles a, FourDoubles b) {
  return {a.low * b.low, a.high * b.high};
}
[[gnu::always_inline]] inline FourFloats operator*(FourFloats a, FourFloats b) {
  return {a.v * b.v};
}
[[gnu::always_inline]] inline FourDoubles fused(FourDoubles x, FourDoubles y, FourDoubles z) {
  return {fused(x.low, y.low, z.low), fused(x.high, y.high, z.high)};
}
[[gnu::always_inline]] inline FourFloats fused(FourFloats x, FourFloats y, FourFloats z) {
  return {fused(x.v, y.v, z.v)};
}
[[gnu::always_inline]] inline FourDoubles fused_from(FourDoubles x, FourDoubles y, FourDoubles z) {
  return {fused(-x.low, y.low, z.low), fused(-x.high, y.high, z.high)};
}
[[gnu::always_inline]] inline FourFloats fused_from(FourFloats x, FourFloats y, FourFloats z) {
  return {fused_from(x.v, y.v, z.v)};
}
#endif

/// The vectors of two particles that stand side by side.
template <class Real>
struct TwoOf {
  FourOf<Real> first, second;
  [[gnu::always_inline]] static TwoOf all(Real a) {
    return {FourOf<Real>::all(a), FourOf<Real>::all(a)};
  }
  /// A number for each.
  [[gnu::always_inline]] static TwoOf each(const Real* a) {
    return {FourOf<Real>::all(a[0]), FourOf<Real>::all(a[1])};
  }
  [[gnu::always_inline]] static TwoOf load(const Real* p) {
    return {FourOf<Real>::load(p), FourOf<Real>::load(p + 4)};
  }
  [[gnu::always_inline]] void store(Real* p) const {
    first.store(p);
    second.store(p + 4);
  }
};
template <class Real>
[[gnu::always_inline]] inline TwoOf<Real> operator+(TwoOf<Real> a, TwoOf<Real> b) {
  return {a.first + b.first, a.second + b.second};
}
template <class Real>
[[gnu::always_inline]] inline TwoOf<Real> operator*(TwoOf<Real> a, TwoOf<Real> b) {
  return {a.first * b.first, a.second * b.second};
}
template <class Real>
[[gnu::always_inline]] inline TwoOf<Real> fused(TwoOf<Real> x, TwoOf<Real> y, TwoOf<Real> z) {
  return {fused(x.first, y.first, z.first), fused(x.second, y.second, z.second)};
}
template <class Real>
[[gnu::always_inline]] inline TwoOf<Real> fused_from(TwoOf<Real> x, TwoOf<Real> y, TwoOf<Real> z) {
  return {fused_from(x.first, y.first, z.first), fused_from(x.second, y.second, z.second)};
}
template <class Real>
[[gnu::always_inline]] inline FourOf<Real> first_and_second(TwoOf<Real> a) {
  return a.first + a.second;
}

#if defined(__AVX2__)
template <>
struct TwoOf<float> {
  __m256 v;
  [[gnu::always_inline]] static TwoOf all(float a) { return {_mm256_set1_ps(a)}; }
  [[gnu::always_inline]] static TwoOf each(const float* a) {
    const __m256 both = _mm256_castsi256_ps(_mm256_castsi128_si256(_mm_loadu_si64(a)));
    return {_mm256_permutevar8x32_ps(both, _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1))};
  }
  [[gnu::always_inline]] static TwoOf load(const float* p) { return {_mm256_loadu_ps(p)}; }
  [[gnu::always_inline]] void store(float* p) const { _mm256_storeu_ps(p, v); }
};
[[gnu::always_inline]] inline TwoOf<float> operator+(TwoOf<float> a, TwoOf<float> b) {
  return {_mm256_add_ps(a.v, b.v)};
}
[[gnu::always_inline]] inline TwoOf<float> operator*(TwoOf<float> a, TwoOf<float> b) {
  return {_mm256_mul_ps(a.v, b.v)};
}
[[gnu::always_inline]] inline TwoOf<float> fused(TwoOf<float> x, TwoOf<float> y, TwoOf<float> z) {
  return {_mm256_fmadd_ps(x.v, y.v, z.v)};
}
[[gnu::always_inline]] inline TwoOf<float> fused_from(TwoOf<float> x, TwoOf<float> y,
                                                      TwoOf<float> z) {
  return {_mm256_fnmadd_ps(x.v, y.v, z.v)};
}
[[gnu::always_inline]] inline FourFloats first_and_second(TwoOf<float> a) {
  return {_mm_add_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1))};
}
#endif

/// In one order, whatever the registers.
template <class Real>
[[gnu::always_inline]] inline double sum(FourOf<Real> a) {
  alignas(32) Real of[4];
  a.store(of);
  return static_cast<double>((of[0] + of[1]) + (of[2] + of[3]));
}
template <class Real>
[[gnu::always_inline]] inline double sum(TwoOf<Real> a) {
  return sum(first_and_second(a));
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
