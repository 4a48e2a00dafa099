/// Particles that stand in a row of memory, kFloats at a time: in quads, or in a woven row.
#pragma once

#include "kernels/simd/quads.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

struct InQuads {
  [[gnu::always_inline]] FloatVector get(const float* from, std::size_t place,
                                         std::uint32_t lane) const {
    return QuadsInRow().get(from + place + 4 * lane);
  }
  [[gnu::always_inline]] void put(float* to, std::size_t place, std::uint32_t lane,
                                  const FloatVector& v) const {
    QuadsInRow().put(to + place + 4 * lane, v);
  }
};
struct InWovenRow {
  [[gnu::always_inline]] FloatVector get(const float* from, std::size_t place,
                                         std::uint32_t lane) const {
    const float* x = from + place + lane;
    return {load(x), load(x + kernels::kLanes), load(x + 2 * kernels::kLanes)};
  }
  [[gnu::always_inline]] void put(float* to, std::size_t place, std::uint32_t lane,
                                  const FloatVector& v) const {
    float* x = to + place + lane;
    v.x.store_unaligned(x);
    v.y.store_unaligned(x + kernels::kLanes);
    v.z.store_unaligned(x + 2 * kernels::kLanes);
  }
};

[[gnu::always_inline]] inline FloatVector select(FloatMask mask, const FloatVector& a,
                                                 const FloatVector& b) {
  return {xsimd::select(mask, a.x, b.x), xsimd::select(mask, a.y, b.y),
          xsimd::select(mask, a.z, b.z)};
}
[[gnu::always_inline]] inline Floats tiny() { return Floats(1e-18f); }
[[gnu::always_inline]] inline Floats over_length(const FloatVector& v) {
  return Floats(1.f) / xsimd::max(xsimd::sqrt(dot(v, v)), tiny());
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
