/// Numbers of the kernels, the same for every instruction set: batches, vectors of batches, and the
/// functions that lanes_sse2.h, lanes_avx2.h, lanes_avx512.h and lanes_neon.h each have in their
/// own way. They define, always inline and with internal linkage:
///
///     kFuses                          whether x y + z is rounded once; else it is rounded twice
///     fused(x, y, z)                  x y + z, of Floats and of Doubles
///     fused_from(x, y, z)             z - x y, of Floats
///     bits(mask), count(mask)         one bit per lane; how many are set
///     load_as_double(p)               widens kDoubles floats
///     store_as_float(p, d)            rounds kDoubles doubles to float
///     to_float_and_back(d)
///     narrow(first, second)           rounds 2 kDoubles doubles to float
///     widen_first(f), widen_second(f) widens the first half of the lanes, and the second
///     load_quads, store_quads, unpack_low, unpack_high, low_pairs, high_pairs
///                                     what a transpose of 4 x 4 in each 128 bits takes (quads.h)
///     in_order(v), out_of_order(v)    from the order of lanes that such transposes leave (for 8
///                                     lanes 0, 2, 4, 6, 1, 3, 5, 7) to the plain one, and back
#pragma once

#if defined(__AVX512F__)
#include "kernels/simd/lanes_avx512.h"
#elif defined(__AVX2__)
#include "kernels/simd/lanes_avx2.h"
#elif defined(__SSE2__)
#include "kernels/simd/lanes_sse2.h"
#else
#include "kernels/simd/lanes_neon.h"
#endif

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// The same bits, as other numbers. (xsimd::bitwise_cast takes a type of batch before xsimd 11, one
/// of numbers since.)
template <class To, class From>
[[gnu::always_inline]] inline To same_bits(From v) {
  return To(std::bit_cast<typename To::register_type>(v.data));
}

[[gnu::always_inline]] inline float fused(float x, float y, float z) {
  if constexpr (kFuses) return __builtin_fmaf(x, y, z);
  return x * y + z;
}
[[gnu::always_inline]] inline double fused(double x, double y, double z) {
  if constexpr (kFuses) return __builtin_fma(x, y, z);
  return x * y + z;
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
[[gnu::always_inline]] inline FloatVector cross(const FloatVector& a, const FloatVector& b) {
  return {fused_from(a.z, b.y, a.y * b.z), fused_from(a.x, b.z, a.z * b.x),
          fused_from(a.y, b.x, a.x * b.y)};
}
[[gnu::always_inline]] inline FloatVector no_vector() {
  return {Floats(0.f), Floats(0.f), Floats(0.f)};
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
