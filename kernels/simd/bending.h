/// Bending elements of small steps, in lanes. Of particle i, with the weight c_i and the inverse
/// mass w_i,
///
///     d = sum of c_i x_i = span + c_0 (u_0 - u_2) + c_1 (u_1 - u_2) + c_3 (u_3 - u_2)
///
/// since the weights sum to zero; span is the same sum over the base. In a substep of h, whose
/// positions move by (b h)^2 w f under a force f that acts during n substeps, a visit changes d by
///
///     nu = - (1 - rest / |d| + tau (d . d') / |d|^2) d / max(a + 1/2, 1 / omega)
///     a  = s / (n (b h)^2),   s = compliance / W,   W = sum of w_i c_i^2
///
/// and moves x_i by (w_i c_i / W) nu. With a + 1 the law would hold when the element has been
/// visited; but those that are visited later take, where all bend alike, half of nu back, since
/// weights sum to zero: it holds in the end of the sweep with a + 1/2. What is too stiff for that
/// is relaxed by omega. d', the rate of d, is that in the beginning of the substep: what has come
/// to rest is not damped, though within a substep it moves.
#pragma once

#include <limits>

#include "kernels/simd/quads.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// Of a block's lanes from `lane` on.
template <bool kFour>
struct BentQuads {
  FloatVector x[kFour ? 4 : 3];

  [[gnu::always_inline]] BentQuads(const float* u, const BendingBlock& block, std::uint32_t lane) {
    for (std::size_t k = 0; k < (kFour ? 4 : 3); ++k)
      x[k] = QuadLanes{}.get(u, block.slot[k] + lane);
  }
  /// The sum of weight times particle.
  [[gnu::always_inline]] FloatVector sum(const BendingBlock& block, std::uint32_t lane) const {
    FloatVector d = load(block.weight[0] + lane) * (x[0] - x[2]);
    d = fused(load(block.weight[1] + lane), x[1] - x[2], d);
    if constexpr (kFour) d = fused(load(block.weight[2] + lane), x[3] - x[2], d);
    return d;
  }
  [[gnu::always_inline]] void move(float* u, const BendingBlock& block, std::uint32_t lane,
                                   const FloatVector& by) {
    for (std::size_t k = 0; k < (kFour ? 4 : 3); ++k) {
      x[k] = fused(load(block.share[k] + lane), by, x[k]);
      QuadLanes{}.put(u, block.slot[k] + lane, x[k]);
    }
  }
};

template <bool kFour>
[[gnu::always_inline]] inline void measure_elements(const BendingBlock* blocks, EdgeSpans* spans,
                                                    const float* base, std::size_t first,
                                                    std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      FloatVector d = BentQuads<kFour>(base, blocks[i], lane).sum(blocks[i], lane);
      d.x.store_unaligned(spans[i].x + lane);
      d.y.store_unaligned(spans[i].y + lane);
      d.z.store_unaligned(spans[i].z + lane);
    }
  }
}

[[gnu::always_inline]] inline FloatVector load_span(const EdgeSpans& span, std::uint32_t lane) {
  return {load(span.x + lane), load(span.y + lane), load(span.z + lane)};
}

/// The factor of d in nu. Where d all but vanishes it has no direction, and what the factor makes
/// of it falls to 0 with it.
template <bool kFour, bool kCurved, bool kDamped>
[[gnu::always_inline]] inline Floats stretched(const Bending& b, const BendingBlock& block,
                                               std::uint32_t lane, const FloatVector& d) {
  const Floats one(1.f), least(std::numeric_limits<float>::min());
  Floats factor = one;
  if constexpr (kCurved || kDamped) {
    const Floats square = dot(d, d);
    if constexpr (kCurved) {
      const Floats rest = load(block.rest + lane);
      const Floats shortest = xsimd::max(Floats(0x1p-20f) * rest, least);
      factor = one - rest / xsimd::max(xsimd::sqrt(square), shortest);
    }
    if constexpr (kDamped) {
      const FloatVector rate = BentQuads<kFour>(b.v, block, lane).sum(block, lane);
      const Floats tau =
          xsimd::min(Floats(b.damping), Floats(b.most) * load(block.softness + lane));
      factor = fused(tau, dot(d, rate) / xsimd::max(square, least), factor);
    }
  }
  return factor;
}

template <bool kFour, bool kCurved, bool kDamped>
[[gnu::always_inline]] inline void bend_elements(const Bending& b, std::size_t first,
                                                 std::size_t last) {
  float* const u = b.u;
  const Floats own(b.own), rate(b.rate), none(0.f);
  for (std::size_t i = first; i < last; ++i) {
    const BendingBlock& block = b.blocks[i];
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      BentQuads<kFour> particles(u, block, lane);
      FloatVector d = load_span(b.spans[i], lane) + particles.sum(block, lane);
      const Floats divisor =
          xsimd::max(fused(rate, load(block.softness + lane), Floats(0.5f)), own);
      const Floats factor = stretched<kFour, kCurved, kDamped>(b, block, lane, d);
      particles.move(u, block, lane, (none - factor / divisor) * d);
    }
  }
}

/// (|d| - rest)^2 / (2 compliance), of what is stiffer than a substep resolves as if it were just
/// resolved. The lanes of a block are added up one after the other, whatever the width of a vector.
template <bool kFour>
[[gnu::always_inline]] inline void measure_energies(const Bending& b, const float* stiffness,
                                                    double* energy, std::size_t first,
                                                    std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    const BendingBlock& block = b.blocks[i];
    alignas(64) float of_lane[kernels::kLanes];
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      FloatVector d =
          load_span(b.spans[i], lane) + BentQuads<kFour>(b.u, block, lane).sum(block, lane);
      const Floats bent = xsimd::sqrt(dot(d, d)) - load(block.rest + lane);
      const Floats part = xsimd::min(Floats(1.f), Floats(b.resolved) * load(block.softness + lane));
      (Floats(0.5f) * part * load(stiffness + kernels::kLanes * i + lane) * bent * bent)
          .store_unaligned(of_lane + lane);
    }
    energy[i] = 0;
    for (const float e : of_lane) energy[i] += static_cast<double>(e);
  }
}

template <bool kFour, bool kCurved>
[[gnu::always_inline]] inline void bend_elements(const Bending& b, std::size_t first,
                                                 std::size_t last) {
  if (b.damping > 0) return bend_elements<kFour, kCurved, true>(b, first, last);
  bend_elements<kFour, kCurved, false>(b, first, last);
}
template <bool kFour>
[[gnu::always_inline]] inline void bend_elements(const Bending& b, std::size_t first,
                                                 std::size_t last) {
  if (b.curved) return bend_elements<kFour, true>(b, first, last);
  bend_elements<kFour, false>(b, first, last);
}

void measure_bending(const BendingBlock* blocks, EdgeSpans* spans, const float* base, bool four,
                     std::size_t first, std::size_t last) {
  if (four) return measure_elements<true>(blocks, spans, base, first, last);
  measure_elements<false>(blocks, spans, base, first, last);
}
void bend(const Bending& b, bool four, std::size_t first, std::size_t last) {
  if (four) return bend_elements<true>(b, first, last);
  bend_elements<false>(b, first, last);
}

void bending_energy(const Bending& b, const float* stiffness, double* energy, bool four,
                    std::size_t first, std::size_t last) {
  if (four) return measure_energies<true>(b, stiffness, energy, first, last);
  measure_energies<false>(b, stiffness, energy, first, last);
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
