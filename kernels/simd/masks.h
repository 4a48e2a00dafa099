/// Skipping by the paper's 64-bit masks (4.3), in lanes. The bit of a constraint is its colour,
/// unique at both ends. A vector is passed over if no lane has its bit set at either end.
///
///   satisfied lane:  clear its bit at both ends
///   corrected lane:  set all bits but its own at both ends
#pragma once

#include "kernels/simd/relax.h"

namespace weft::simd {
namespace {

[[gnu::always_inline]] inline bool any_marked(const std::uint64_t* a, const std::uint64_t* b,
                                              std::uint64_t bit) {
  std::uint64_t marks = 0;
  for (std::uint32_t k = 0; k < kFloats; ++k) marks |= a[k] | b[k];
  return (marks & bit) != 0;
}

[[gnu::always_inline]] inline void update_marks(std::uint64_t* mask, std::uint32_t corrected,
                                                std::uint64_t bit) {
  for (std::uint32_t k = 0; k < kFloats; ++k) {
    const std::uint64_t moved = 0 - static_cast<std::uint64_t>((corrected >> k) & 1u);
    mask[k] = (mask[k] | moved) & ~bit;
  }
}

std::uint32_t relax_masked_run(const Relaxation& r, const Run& run, std::uint64_t bit,
                               std::uint64_t& visits) {
  const Floats threshold(r.threshold);
  std::uint32_t corrections = 0;
  for (std::size_t k = 0; k < run.length; k += kFloats) {
    const std::size_t a = run.a + k, b = run.b + k, c = run.constraint + k;
    if (!any_marked(r.mask + a, r.mask + b, bit)) continue;
    visits += kFloats;
    const FloatVector n = load(r.n, c);
    FloatVector ua = load(r.u, a), ub = load(r.u, b);
    const Corrected corrected = correct_distances(r, c, errors(r, c, n, ua - ub), threshold);
    const std::uint32_t lanes = bits(corrected.lanes);
    update_marks(r.mask + a, lanes, bit);
    update_marks(r.mask + b, lanes, bit);
    if (lanes == 0) continue;
    corrections += static_cast<std::uint32_t>(std::popcount(lanes));
    move(ua, n, corrected.by * load(r.gain_a + c));
    move(ub, n, corrected.by * load(r.gain_b + c));
    store(r.u, a, ua);
    store(r.u, b, ub);
  }
  return corrections;
}

}  // namespace
}  // namespace weft::simd
