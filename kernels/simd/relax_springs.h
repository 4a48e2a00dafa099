/// One pass over constraints of one colour that may be springs (relax.h has the rigid ones):
///
///     e = e0 + n . (u_a - u_b) - compliance_share impulse
///     if |e| > threshold:  u_a += gain_a e n,  u_b += gain_b e n,  impulse += e
///
/// impulse is the sum of corrections since directions were renewed. Their sum before that, `held`,
/// is in e0 already, in double. With s = softness = compliance / h^2
///
///     compliance_share = s / (w_a + w_b + s),   gain_a = -tau^2 w_a / (w_a + w_b + s),   gain_b
///     likewise
///
/// so that a correction takes all of the error away. Ropes keep held + impulse at or above 0.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/simd/relax.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

template <bool kRope>
[[gnu::always_inline]] inline Corrected correct_springs(const BlockRelaxation& r, std::size_t c,
                                                        Floats e, Floats threshold) {
  const Floats sum = load(r.impulse + c);
  Floats change = fused_from(load(r.compliance_share + c), sum, e);
  FloatMask lanes = xsimd::abs(change) > threshold;
  if constexpr (kRope) {
    change = xsimd::max(change, Floats(0.f) - (load(r.held + c) + sum));
    lanes = lanes & (change != Floats(0.f));
  }
  Floats by = xsimd::select(lanes, change, Floats(0.f));
  (sum + by).store_unaligned(r.impulse + c);
  return {lanes, by};
}

std::uint32_t relax_spring_run(const BlockRelaxation& r, const Run& run, bool rope) {
  return rope ? relax_any_contiguous(r, run, correct_springs<true>)
              : relax_any_contiguous(r, run, correct_springs<false>);
}

std::uint32_t relax_spring_singles(const BlockRelaxation& r, std::uint32_t first,
                                   std::uint32_t last, bool rope) {
  return rope ? relax_any_scattered(r, first, last, correct_springs<true>)
              : relax_any_scattered(r, first, last, correct_springs<false>);
}

std::uint32_t relax_spring_serial(const BlockRelaxation& r, std::uint32_t first, std::uint32_t last,
                                  bool rope) {
  return relax_one_by_one(r, first, last, [&](std::size_t c, float e) {
    float change = fused(-r.compliance_share[c], r.impulse[c], e);
    if (!(std::abs(change) > r.threshold)) return 0.f;
    if (rope) change = std::max(change, -(r.held[c] + r.impulse[c]));
    r.impulse[c] += change;
    return change;
  });
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
