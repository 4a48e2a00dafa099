/// xsimd batches under the names of this project, and what xsimd 8.1 lacks.
///
/// Everything in the kernels' headers has internal linkage: each instruction set compiles them
/// anew, and a function shared between two of them could be linked from the wrong one.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "kernels/runs.h"
#include "kernels/simd/table.h"

// The namespace of these kernels, so that profiles tell the instruction sets apart.
#if defined(__AVX512F__)
#define WEFT_LANES avx512
#elif defined(__AVX2__)
#define WEFT_LANES avx2
#else
#define WEFT_LANES sse2
#endif

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

#if defined(__AVX512F__)
using Arch = xsimd::avx512f;
#elif defined(__AVX2__)
using Arch = xsimd::fma3<xsimd::avx2>;
#else
using Arch = xsimd::sse2;
#endif

using Floats = xsimd::batch<float, Arch>;
using Doubles = xsimd::batch<double, Arch>;
using Ints = xsimd::batch<std::int32_t, Arch>;
using FloatMask = Floats::batch_bool_type;
using DoubleMask = Doubles::batch_bool_type;

constexpr std::uint32_t kFloats = Floats::size;
constexpr std::uint32_t kDoubles = Doubles::size;
static_assert(kernels::kLanes % kFloats == 0);

/// The same bits, as other numbers. (xsimd::bitwise_cast takes a type of batch before xsimd 11, one
/// of numbers since.)
template <class To, class From>
[[gnu::always_inline]] inline To same_bits(From v) {
  return To(std::bit_cast<typename To::register_type>(v.data));
}

/// x y + z, rounded once where the machine can. xsimd 8.1 has no fma for avx512f.
[[gnu::always_inline]] inline Floats fused(Floats x, Floats y, Floats z) {
#if defined(__AVX512F__)
  return Floats(_mm512_fmadd_ps(x, y, z));
#else
  return xsimd::fma(x, y, z);
#endif
}

/// z - x y, likewise.
[[gnu::always_inline]] inline Floats fused_from(Floats x, Floats y, Floats z) {
#if defined(__AVX512F__)
  return Floats(_mm512_fnmadd_ps(x, y, z));
#else
  return xsimd::fnma(x, y, z);
#endif
}

[[gnu::always_inline]] inline Doubles fused(Doubles x, Doubles y, Doubles z) {
#if defined(__AVX512F__)
  return Doubles(_mm512_fmadd_pd(x, y, z));
#else
  return xsimd::fma(x, y, z);
#endif
}

[[gnu::always_inline]] inline float fused(float x, float y, float z) {
#if defined(__AVX2__)
  return __builtin_fmaf(x, y, z);
#else
  return x * y + z;
#endif
}
[[gnu::always_inline]] inline double fused(double x, double y, double z) {
#if defined(__AVX2__)
  return __builtin_fma(x, y, z);
#else
  return x * y + z;
#endif
}

/// One bit per lane.
[[gnu::always_inline]] inline std::uint32_t bits(FloatMask mask) {
#if defined(__AVX512F__)
  return static_cast<std::uint32_t>(static_cast<__mmask16>(mask));
#elif defined(__AVX2__)
  return static_cast<std::uint32_t>(_mm256_movemask_ps(mask));
#else
  return static_cast<std::uint32_t>(_mm_movemask_ps(mask));
#endif
}

[[gnu::always_inline]] inline std::uint32_t count(FloatMask mask) {
#if defined(__AVX2__)
  return static_cast<std::uint32_t>(__builtin_popcount(bits(mask)));
#else
  return (0x4332322132212110u >> (4 * bits(mask))) & 15;  // plain SSE2 has no popcnt
#endif
}

/// Three batches: a vector per lane.
///
/// Locals of several batches are not const in these headers, and of one where that was measured to
/// matter. GCC 12 does not split a const aggregate that an inlined function fills ("a store to a
/// read-only decl"): it stays in memory, and is written for every row or constraint though nobody
/// reads it. Sweeps along the directions at the start took twice as long on AVX2.
template <class Batch>
struct VectorOf {
  Batch x, y, z;
};
using FloatVector = VectorOf<Floats>;
using DoubleVector = VectorOf<Doubles>;

[[gnu::always_inline]] inline Floats load(const float* p) { return Floats::load_unaligned(p); }
[[gnu::always_inline]] inline Doubles load(const double* p) { return Doubles::load_unaligned(p); }

[[gnu::always_inline]] inline FloatVector load(const Displacements& u, std::size_t i) {
  const float* x = u.x + i;
  return {load(x), load(x + u.stride), load(x + 2 * u.stride)};
}
[[gnu::always_inline]] inline DoubleVector load(const kernels::VectorsView& v, std::size_t i) {
  return {load(v.x + i), load(v.y + i), load(v.z + i)};
}
[[gnu::always_inline]] inline FloatVector load(const LaneVectors& v, std::uint32_t lane) {
  return {load(v.x + lane), load(v.y + lane), load(v.z + lane)};
}
[[gnu::always_inline]] inline void store(const Displacements& u, std::size_t i,
                                         const FloatVector& f) {
  float* x = u.x + i;
  f.x.store_unaligned(x);
  f.y.store_unaligned(x + u.stride);
  f.z.store_unaligned(x + 2 * u.stride);
}
[[gnu::always_inline]] inline void store(const kernels::VectorsView& v, std::size_t i,
                                         const DoubleVector& d) {
  d.x.store_unaligned(v.x + i);
  d.y.store_unaligned(v.y + i);
  d.z.store_unaligned(v.z + i);
}

[[gnu::always_inline]] inline void store(LaneVectors& v, std::uint32_t lane, const FloatVector& f) {
  f.x.store_unaligned(v.x + lane);
  f.y.store_unaligned(v.y + lane);
  f.z.store_unaligned(v.z + lane);
}

template <class Batch>
[[gnu::always_inline]] inline VectorOf<Batch> operator+(const VectorOf<Batch>& a,
                                                        const VectorOf<Batch>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Batch>
[[gnu::always_inline]] inline VectorOf<Batch> operator-(const VectorOf<Batch>& a,
                                                        const VectorOf<Batch>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Batch>
[[gnu::always_inline]] inline VectorOf<Batch> operator*(Batch s, const VectorOf<Batch>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
/// s b + a
template <class Batch>
[[gnu::always_inline]] inline VectorOf<Batch> fused(Batch s, const VectorOf<Batch>& b,
                                                    const VectorOf<Batch>& a) {
  return {fused(s, b.x, a.x), fused(s, b.y, a.y), fused(s, b.z, a.z)};
}
/// a - s b
template <class Batch>
[[gnu::always_inline]] inline VectorOf<Batch> fused_from(Batch s, const VectorOf<Batch>& b,
                                                         const VectorOf<Batch>& a) {
  return {fused_from(s, b.x, a.x), fused_from(s, b.y, a.y), fused_from(s, b.z, a.z)};
}
template <class Batch>
[[gnu::always_inline]] inline Batch dot(const VectorOf<Batch>& a, const VectorOf<Batch>& b) {
  return fused(a.x, b.x, fused(a.y, b.y, a.z * b.z));
}
[[gnu::always_inline]] inline FloatVector no_vector() {
  return {Floats(0.f), Floats(0.f), Floats(0.f)};
}

/// Rounds kDoubles doubles to float.
[[gnu::always_inline]] inline void store_as_float(float* p, Doubles d) {
#if defined(__AVX512F__)
  _mm256_storeu_ps(p, _mm512_cvtpd_ps(d));
#elif defined(__AVX2__)
  _mm_storeu_ps(p, _mm256_cvtpd_ps(d));
#else
  _mm_storel_pi(reinterpret_cast<__m64*>(p), _mm_cvtpd_ps(d));
#endif
}

[[gnu::always_inline]] inline Doubles to_float_and_back(Doubles d) {
#if defined(__AVX512F__)
  return Doubles(_mm512_cvtps_pd(_mm512_cvtpd_ps(d)));
#elif defined(__AVX2__)
  return Doubles(_mm256_cvtps_pd(_mm256_cvtpd_ps(d)));
#else
  return Doubles(_mm_cvtps_pd(_mm_cvtpd_ps(d)));
#endif
}

/// Rounds 2 kDoubles doubles to float.
[[gnu::always_inline]] inline Floats narrow(Doubles first, Doubles second) {
#if defined(__AVX512F__)
  return Floats(_mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(first)),
                                   _mm512_cvtpd_ps(second), 1));
#elif defined(__AVX2__)
  return Floats(_mm256_set_m128(_mm256_cvtpd_ps(second), _mm256_cvtpd_ps(first)));
#else
  return Floats(_mm_movelh_ps(_mm_cvtpd_ps(first), _mm_cvtpd_ps(second)));
#endif
}

/// Widens the first half of the lanes, and the second.
[[gnu::always_inline]] inline Doubles widen_first(Floats f) {
#if defined(__AVX512F__)
  return Doubles(_mm512_cvtps_pd(_mm512_castps512_ps256(f)));
#elif defined(__AVX2__)
  return Doubles(_mm256_cvtps_pd(_mm256_castps256_ps128(f)));
#else
  return Doubles(_mm_cvtps_pd(f));
#endif
}
[[gnu::always_inline]] inline Doubles widen_second(Floats f) {
#if defined(__AVX512F__)
  return Doubles(_mm512_cvtps_pd(_mm512_extractf32x8_ps(f, 1)));
#elif defined(__AVX2__)
  return Doubles(_mm256_cvtps_pd(_mm256_extractf128_ps(f, 1)));
#else
  return Doubles(_mm_cvtps_pd(_mm_movehl_ps(f, f)));
#endif
}

/// Widens kDoubles floats.
[[gnu::always_inline]] inline Doubles load_as_double(const float* p) {
#if defined(__AVX512F__)
  return Doubles(_mm512_cvtps_pd(_mm256_loadu_ps(p)));
#elif defined(__AVX2__)
  return Doubles(_mm256_cvtps_pd(_mm_loadu_ps(p)));
#else
  return Doubles(_mm_cvtps_pd(_mm_loadl_pi(_mm_setzero_ps(), reinterpret_cast<const __m64*>(p))));
#endif
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
