/// Skipping by the paper's 64-bit masks (4.3), in lanes. The bit of a constraint is its colour,
/// unique at both ends. A vector is passed over if no lane has its bit set at either end.
///
///   satisfied lane:  clear its bit at both ends
///   corrected lane:  set all bits but its own at both ends
///
/// Rounding may leave a corrected lane out of tolerance: displacements of 2^24 times the tolerance
/// are not known any better. Its own bit is then set as well.
#pragma once

#include "kernels/simd/relax.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

using Words = xsimd::batch<std::uint64_t, Arch>;
constexpr std::uint32_t kWords = Words::size;

/// The marks of kFloats slots.
struct Marks {
  Words words[kFloats / kWords];

  [[gnu::always_inline]] explicit Marks(const std::uint64_t* mask) {
    for (std::uint32_t i = 0; i < kFloats / kWords; ++i) {
      words[i] = Words::load_unaligned(mask + i * kWords);
    }
  }
  /// As bits, one per lane: which were corrected, and which of these are still out of tolerance.
  [[gnu::always_inline]] void update(std::uint64_t* mask, std::uint32_t corrected,
                                     std::uint32_t left, std::uint64_t bit) const {
    alignas(64) static constexpr std::uint64_t kLaneBits[16] = {
        1u << 0, 1u << 1, 1u << 2,  1u << 3,  1u << 4,  1u << 5,  1u << 6,  1u << 7,
        1u << 8, 1u << 9, 1u << 10, 1u << 11, 1u << 12, 1u << 13, 1u << 14, 1u << 15};
    const Words all(~std::uint64_t{0}), others(~bit), none(std::uint64_t{0});
    const Words moved_lanes(corrected), left_lanes(left);
    for (std::uint32_t i = 0; i < kFloats / kWords; ++i) {
      const Words lane = Words::load_aligned(kLaneBits + i * kWords);
      const Words moved = xsimd::select((left_lanes & lane) == none, others, all);
      xsimd::select((moved_lanes & lane) == none, words[i] & others, moved)
          .store_unaligned(mask + i * kWords);
    }
  }
};

[[gnu::always_inline]] inline bool any_marked(const Marks& a, const Marks& b, std::uint64_t bit) {
  Words marks = a.words[0] | b.words[0];
  for (std::uint32_t i = 1; i < kFloats / kWords; ++i) marks = marks | a.words[i] | b.words[i];
  return xsimd::any((marks & Words(bit)) != Words(std::uint64_t{0}));
}

std::uint32_t relax_masked_run(const BlockRelaxation& r, const Run& run, std::uint64_t bit,
                               std::uint64_t& visits) {
  const Floats threshold(r.threshold);
  std::uint32_t corrections = 0;
  for (std::size_t k = 0; k < run.length; k += kFloats) {
    const std::size_t a = run.a + k, b = run.b + k, c = run.constraint + k;
    const Marks at_a(r.mask + a), at_b(r.mask + b);
    if (!any_marked(at_a, at_b, bit)) continue;
    visits += kFloats;
    const Part p = part(r, c);
    if (r.from_memory && p.lane == 0) fetch_ahead(p.block);
    FloatVector n = p.n();
    FloatVector ua = load(r.u, a), ub = load(r.u, b);
    Corrected corrected = correct_distances(r, c, errors(p, n, ua - ub), threshold);
    const std::uint32_t lanes = bits(corrected.lanes);
    std::uint32_t left = 0;
    if (lanes != 0) {
      corrections += count(corrected.lanes);
      ua = fused(corrected.by * p.gain_a(), n, ua);
      ub = fused(corrected.by * p.gain_b(), n, ub);
      store(r.u, a, ua);
      store(r.u, b, ub);
      left = bits(xsimd::abs(errors(p, n, ua - ub)) > threshold);
    }
    at_a.update(r.mask + a, lanes, left, bit);
    at_b.update(r.mask + b, lanes, left, bit);
  }
  return corrections;
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
