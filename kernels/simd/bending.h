/// Bending elements of small steps, in lanes. Of particle i, with the weight c_i,
///
///     d = sum of c_i x_i = span + c_0 (u_0 - u_2) + c_1 (u_1 - u_2) + c_3 (u_3 - u_2)
///
/// since the weights sum to zero; span is the same sum over the base. An element pulls particle i
/// by c_i f,
///
///     f = - k ((1 - rest / |d|) d + damping (d - turned(d, s))),
///
/// where s is the d of the start of the substep (kernels/reference/bending.h). What rounding does
/// to d is a moment, and to a sum of pulls no more than to these: a stiff cloth is not pushed away
/// by it.
#pragma once

#include <limits>

#include "kernels/reference/bending.h"
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
  [[gnu::always_inline]] BentQuads since(const BentQuads& start) const {
    BentQuads by = *this;
    for (std::size_t k = 0; k < (kFour ? 4 : 3); ++k) by.x[k] = x[k] - start.x[k];
    return by;
  }
  /// The sum of weight times particle.
  [[gnu::always_inline]] FloatVector sum(const BendingBlock& block, std::uint32_t lane) const {
    FloatVector d = load(block.weight[0] + lane) * (x[0] - x[2]);
    d = fused(load(block.weight[1] + lane), x[1] - x[2], d);
    if constexpr (kFour) d = fused(load(block.weight[2] + lane), x[3] - x[2], d);
    return d;
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

/// (1 - rest / |d|) d. Where d all but vanishes it has no direction, and this falls to 0 with it.
[[gnu::always_inline]] inline FloatVector curved(const BendingBlock& block, std::uint32_t lane,
                                                 const FloatVector& d) {
  const Floats rest = load(block.rest + lane), least(std::numeric_limits<float>::min());
  const Floats shortest = xsimd::max(Floats(0x1p-20f) * rest, least);
  return (Floats(1.f) - rest / xsimd::max(xsimd::sqrt(dot(d, d)), shortest)) * d;
}

/// d - turned(d, s), by = d - s: of what has turned by as much as |d| has grown.
[[gnu::always_inline]] inline FloatVector bent(const FloatVector& d, const FloatVector& by) {
  const Floats one(1.f), none(0.f), least(std::numeric_limits<float>::min());
  const FloatVector s = d - by;
  const Floats now = xsimd::sqrt(dot(d, d)), before = xsimd::sqrt(dot(s, s));
  const Floats cosine = xsimd::max(none, dot(d, s) / xsimd::max(now * before, least));
  const Floats sine = one - cosine * cosine;
  const Floats part =
      xsimd::max(none, one - Floats(static_cast<float>(1 / reference::kMostTurn)) * sine);
  const Floats grown = dot(by, d + s) / xsimd::max(now * (now + before), least);
  return (one - part) * by + (part * grown) * d;
}

[[gnu::always_inline]] inline void pull_quad(float* to, const std::uint32_t* slot, Floats weight,
                                             const FloatVector& f) {
  QuadLanes{}.put(to, slot, fused(weight, f, QuadLanes{}.get(to, slot)));
}
/// The weights sum to zero as they are rounded: so do the pulls, but for their own rounding.
template <bool kFour>
[[gnu::always_inline]] inline void pull_quads(float* to, const BendingBlock& block,
                                              std::uint32_t lane, const FloatVector& f) {
  const Floats w0 = load(block.weight[0] + lane), w1 = load(block.weight[1] + lane);
  Floats others = w0 + w1;
  pull_quad(to, block.slot[0] + lane, w0, f);
  pull_quad(to, block.slot[1] + lane, w1, f);
  if constexpr (kFour) {
    const Floats w3 = load(block.weight[2] + lane);
    others = others + w3;
    pull_quad(to, block.slot[3] + lane, w3, f);
  }
  pull_quad(to, block.slot[2] + lane, Floats(0.f) - others, f);
}

template <bool kFour, bool kCurved, bool kDamped>
[[gnu::always_inline]] inline void pull_elements(const Bending& b, float* to, std::size_t first,
                                                 std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    const BendingBlock& block = b.blocks[i];
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      const BentQuads<kFour> at(b.u, block, lane);
      const FloatVector d = load_span(b.spans[i], lane) + at.sum(block, lane);
      FloatVector f = d;
      if constexpr (kCurved) f = curved(block, lane, d);
      if constexpr (kDamped) {
        const FloatVector by = at.since(BentQuads<kFour>(b.start, block, lane)).sum(block, lane);
        f = fused(Floats(b.damping), bent(d, by), f);
      }
      pull_quads<kFour>(to, block, lane, (Floats(0.f) - load(block.stiffness + lane)) * f);
    }
  }
}

/// (|d| - rest)^2 k / 2, of what is stiffer than a substep resolves as if it were just resolved.
/// The lanes of a block are added up one after the other, whatever the width of a vector.
template <bool kFour>
[[gnu::always_inline]] inline void measure_energies(const Bending& b, double* energy,
                                                    std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    const BendingBlock& block = b.blocks[i];
    alignas(64) float of_lane[kernels::kLanes];
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      FloatVector d =
          load_span(b.spans[i], lane) + BentQuads<kFour>(b.u, block, lane).sum(block, lane);
      const Floats bent = xsimd::sqrt(dot(d, d)) - load(block.rest + lane);
      const Floats part = xsimd::min(Floats(1.f), Floats(b.resolved) * load(block.softness + lane));
      (Floats(0.5f) * part * load(block.stiffness + lane) * bent * bent)
          .store_unaligned(of_lane + lane);
    }
    energy[i] = 0;
    for (const float e : of_lane) energy[i] += static_cast<double>(e);
  }
}

template <bool kFour, bool kCurved>
[[gnu::always_inline]] inline void pull_elements(const Bending& b, float* to, std::size_t first,
                                                 std::size_t last) {
  if (b.damping > 0) return pull_elements<kFour, kCurved, true>(b, to, first, last);
  pull_elements<kFour, kCurved, false>(b, to, first, last);
}
template <bool kFour>
[[gnu::always_inline]] inline void pull_elements(const Bending& b, float* to, std::size_t first,
                                                 std::size_t last) {
  if (b.curved) return pull_elements<kFour, true>(b, to, first, last);
  pull_elements<kFour, false>(b, to, first, last);
}

void measure_bending(const BendingBlock* blocks, EdgeSpans* spans, const float* base, bool four,
                     std::size_t first, std::size_t last) {
  if (four) return measure_elements<true>(blocks, spans, base, first, last);
  measure_elements<false>(blocks, spans, base, first, last);
}
void pull_bending(const Bending& b, float* to, bool four, std::size_t first, std::size_t last) {
  if (four) return pull_elements<true>(b, to, first, last);
  pull_elements<false>(b, to, first, last);
}

void bending_energy(const Bending& b, double* energy, bool four, std::size_t first,
                    std::size_t last) {
  if (four) return measure_energies<true>(b, energy, first, last);
  measure_energies<false>(b, energy, first, last);
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
