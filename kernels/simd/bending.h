/// Bending elements of small steps, in lanes. With the weight c_i of particle i,
///
///     d = sum of c_i x_i = span + c_0 (u_0 - u_2) + c_1 (u_1 - u_2) + c_3 (u_3 - u_2)
///
/// since the weights sum to zero; span is the same sum over the base. An element pulls particle i
/// by c_i f,
///
///     f = - k ((1 - rest / |d|) d + damping bent),
///
/// or that of a hinge which is folded at rest (kernels/reference/bending.h),
/// where bent is the change of d since the start of the substep in a frame that turns with the
/// element, as its arms tell (kernels/reference/bending.h). Rounding of d makes a moment, and of a
/// sum of pulls no more than of these: it does not push a stiff cloth away.
#pragma once

#include <limits>

#include "kernels/reference/bending.h"
#include "kernels/simd/in_rows.h"
#include "kernels/simd/quads.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// The particles of a block's lanes from `lane` on; with arms, those beside three as well.
template <bool kFour, bool kArms = false>
struct BentQuads {
  static constexpr std::size_t kCount = kFour || kArms ? 4 : 3;
  FloatVector x[kCount];

  [[gnu::always_inline]] BentQuads(const float* u, const BendingBlock& block, std::uint32_t lane) {
    for (std::size_t k = 0; k < kCount; ++k) x[k] = QuadLanes{}.get(u, block.slot[k] + lane);
  }
  [[gnu::always_inline]] BentQuads since(const BentQuads& start) const {
    BentQuads by = *this;
    for (std::size_t k = 0; k < kCount; ++k) by.x[k] = x[k] - start.x[k];
    return by;
  }
  /// The sum of weight times particle.
  [[gnu::always_inline]] FloatVector sum(const BendingBlock& block, std::uint32_t lane) const {
    FloatVector d = load(block.weight[0] + lane) * (x[0] - x[2]);
    d = fused(load(block.weight[1] + lane), x[1] - x[2], d);
    if constexpr (kFour) d = fused(load(block.weight[2] + lane), x[3] - x[2], d);
    return d;
  }
  /// c_3 (x_3 - x_0) - c_2 (x_2 - x_0)
  [[gnu::always_inline]] FloatVector sides(const BendingBlock& block,
                                           std::uint32_t lane) const requires kFour {
    const Floats w3 = load(block.weight[2] + lane);
    const Floats w2 =
        Floats(0.f) - (load(block.weight[0] + lane) + load(block.weight[1] + lane) + w3);
    return w3 * (x[3] - x[0]) - w2 * (x[2] - x[0]);
  }
  [[gnu::always_inline]] FloatVector along() const { return x[0] - x[kFour ? 1 : 2]; }
  [[gnu::always_inline]] FloatVector across() const requires kArms {
    return x[3] - x[kFour ? 2 : 1];
  }
};

[[gnu::always_inline]] inline void store_span(EdgeSpans& span, std::uint32_t lane,
                                              const FloatVector& v) {
  v.x.store_unaligned(span.x + lane);
  v.y.store_unaligned(span.y + lane);
  v.z.store_unaligned(span.z + lane);
}
[[gnu::always_inline]] inline FloatVector load_span(const EdgeSpans& span, std::uint32_t lane) {
  return {load(span.x + lane), load(span.y + lane), load(span.z + lane)};
}

template <bool kFour, bool kArms>
[[gnu::always_inline]] inline void measure_elements(const BendingBlock* blocks,
                                                    const BendingSpans& spans, const float* base,
                                                    std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      const BentQuads<kFour, kArms> at(base, blocks[i], lane);
      store_span(spans.d[i], lane, at.sum(blocks[i], lane));
      if constexpr (kFour) {
        if (spans.sides != nullptr) {
          store_span(spans.sides[i], lane, at.sides(blocks[i], lane));
          store_span(spans.along[i], lane, at.along());
        }
      }
      if constexpr (kArms) {
        store_span(spans.along[i], lane, at.along());
        store_span(spans.across[i], lane, at.across());
      }
    }
  }
}

/// (1 - rest / |d|) d. Where d all but vanishes it has no direction, and this falls to 0 with it.
[[gnu::always_inline]] inline FloatVector curved(const BendingBlock& block, std::uint32_t lane,
                                                 const FloatVector& d) {
  const Floats rest = load(block.rest + lane), least(std::numeric_limits<float>::min());
  const Floats shortest = xsimd::max(Floats(0x1p-20f) * rest, least);
  return (Floats(1.f) - rest / xsimd::max(xsimd::sqrt(dot(d, d)), shortest)) * d;
}

/// A vector that goes from v - by / 2 to v + by / 2.
struct Way {
  FloatVector v, by;
  /// To `to`.
  [[gnu::always_inline]] static Way ending(const FloatVector& to, const FloatVector& by) {
    return {fused_from(Floats(0.5f), by, to), by};
  }
};

/// How an element turns (kernels/reference/bending.h).
[[gnu::always_inline]] inline FloatVector turn_of(const Way& along, const Way& across) {
  const Floats quarter(0.25f), least(std::numeric_limits<float>::min());
  const Floats square = dot(along.v, along.v);
  const Floats size = xsimd::max(xsimd::max(square, quarter * dot(along.by, along.by)), least);
  FloatVector swing = (Floats(1.f) / size) * cross(along.v, along.by);
  FloatVector rest = across.by - cross(swing, across.v);
  FloatVector normal = cross(along.v, across.v);
  const Floats most = quarter * (square * dot(rest, rest));
  const Floats twist = dot(normal, rest) / xsimd::max(xsimd::max(dot(normal, normal), most), least);
  return fused(twist, along.v, swing);
}

/// Half of the sum of the weights' sizes.
template <bool kFour>
[[gnu::always_inline]] inline Floats reach_of(const BendingBlock& block, std::uint32_t lane) {
  const Floats w0 = load(block.weight[0] + lane), w1 = load(block.weight[1] + lane);
  Floats sizes = xsimd::abs(w0) + xsimd::abs(w1), others = w0 + w1;
  if constexpr (kFour) {
    const Floats w3 = load(block.weight[2] + lane);
    sizes = sizes + xsimd::abs(w3);
    others = others + w3;
  }
  return Floats(0.5f) * (sizes + xsimd::abs(others));
}

/// The change of d, `by` in space, in a frame that turns with the element. at: by how much
/// particles have moved since the base, moved: since the start of the substep.
template <bool kFour>
[[gnu::always_inline]] inline FloatVector bent(const Bending& b, std::size_t block,
                                               std::uint32_t lane, const BentQuads<kFour, true>& at,
                                               const BentQuads<kFour, true>& moved,
                                               const FloatVector& d, const FloatVector& by) {
  const Way of_d = Way::ending(d, by);
  const Way along = Way::ending(load_span(b.spans.along[block], lane) + at.along(), moved.along());
  Way across = Way::ending(load_span(b.spans.across[block], lane) + at.across(), moved.across());
  if constexpr (!kFour) {
    const Floats alone = load(b.blocks[block].weight[2] + lane);
    across = {fused(alone, of_d.v, across.v), fused(alone, by, across.by)};
  }
  const FloatVector for_arms = by - cross(turn_of(along, across), of_d.v);
  const Floats reach = reach_of<kFour>(b.blocks[block], lane);
  const Floats flat = reach * reach * dot(along.v, along.v), folded = dot(of_d.v, of_d.v);
  const Floats part =
      Floats(1.f) / xsimd::max(flat + folded, Floats(std::numeric_limits<float>::min()));
  return fused(part * flat, for_arms, (part * dot(of_d.v, by)) * of_d.v);
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

/// A hinge that is folded at rest (kernels/reference/bending.h). The fold of any other is 0.
struct Hinge {
  FloatVector d, edge, across, normal;
  Floats fold, reciprocal, g;
  decltype(Floats() < Floats()) is_flat, is_pressed;
  bool yields;

  template <bool kArms>
  [[gnu::always_inline]] Hinge(const Bending& b, std::size_t block, std::uint32_t lane,
                               const BentQuads<true, kArms>& at, const FloatVector& of_weights)
      : d(of_weights),
        edge(Floats(-1.f) * (load_span(b.spans.along[block], lane) + at.along())),
        across(load_span(b.spans.sides[block], lane) + at.sides(b.blocks[block], lane)),
        normal(cross(edge, across)),
        fold(load(b.folds[block].fold + lane)),
        yields(b.yields) {
    const Floats full = xsimd::sqrt(dot(normal, normal)),
                 least = Floats(static_cast<float>(reference::kFlattestFold)) *
                         xsimd::sqrt(dot(edge, edge) * dot(d, d));
    is_flat = full < least;
    reciprocal = Floats(1.f) / xsimd::max(xsimd::max(full, least), tiny());
    normal = reciprocal * normal;
    g = dot(d, normal);
    if (!yields) return;
    is_pressed = is_flat & (load(b.folds[block].yields + lane) > Floats(0.5f));
    const Floats size = xsimd::sqrt(dot(d, d));
    g = xsimd::select(is_pressed, xsimd::select(g < Floats(0.f), Floats(0.f) - size, size), g);
  }
  static Floats tiny() { return Floats(std::numeric_limits<float>::min()); }

  /// |d|^2 - 2 fold g + fold^2
  [[gnu::always_inline]] Floats bent_square() const { return dot(d, d) - fold * (g + g - fold); }
  /// bent: d, or what is beyond its rest; damping acts on d, too.
  [[gnu::always_inline]] void pull(float* to, const BendingBlock& block, std::uint32_t lane,
                                   const FloatVector& bent, const FloatVector& damping,
                                   float resolved) const {
    const Floats stiffness = load(block.stiffness + lane);
    const Floats none(0.f), w0 = load(block.weight[0] + lane), w1 = load(block.weight[1] + lane),
                            w3 = load(block.weight[2] + lane), w2 = none - (w0 + w1 + w3);
    const Floats of_flat = xsimd::select(is_flat, g, none), of_other = g - of_flat;
    const Floats part = fold * stiffness, over = fold * reciprocal;
    const Floats squares = fused(w0, w0, fused(w1, w1, fused(w2, w2, w3 * w3)));
    const Floats sides =
        fused(Floats(4.f) / xsimd::max(squares, tiny()), dot(across, across), dot(edge, edge));
    const Floats of_turning = (over * sides) * over;
    const Floats softness = Floats(resolved) * load(block.softness + lane);
    Floats turning = part * xsimd::min(Floats(1.f), softness / xsimd::max(of_turning, tiny()));
    if (yields) turning = xsimd::select(is_pressed, none, turning);
    FloatVector by_d = fused_from(of_flat / xsimd::max(dot(d, d), tiny()), d, normal);
    const FloatVector by_normal = reciprocal * fused_from(of_other, normal, d);
    if (yields) by_d = select(is_pressed, (g / xsimd::max(g * g, tiny())) * d, by_d);
    const FloatVector of_d = fused_from(stiffness, bent, fused(part, by_d, damping));
    const FloatVector of_across = turning * cross(by_normal, edge);
    const Floats along = of_flat / xsimd::max(dot(edge, edge), tiny());
    const FloatVector of_edge = turning * fused_from(along, edge, cross(across, by_normal));
    const auto add = [&](std::size_t k, const FloatVector& by) {
      const std::uint32_t* const slot = block.slot[k] + lane;
      QuadLanes{}.put(to, slot, QuadLanes{}.get(to, slot) + by);
    };
    add(0, fused(w0, of_d, fused(w2 - w3, of_across, Floats(-1.f) * of_edge)));
    add(1, fused(w1, of_d, of_edge));
    add(2, w2 * (of_d - of_across));
    add(3, w3 * (of_d + of_across));
  }
};

template <bool kFour, bool kCurved, bool kDamped, bool kFolded>
[[gnu::always_inline]] inline void pull_elements(const Bending& b, float* to, std::size_t first,
                                                 std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    const BendingBlock& block = b.blocks[i];
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      const BentQuads<kFour, kDamped> at(b.u, block, lane);
      const FloatVector d = load_span(b.spans.d[i], lane) + at.sum(block, lane);
      const Floats stiffness = load(block.stiffness + lane);
      FloatVector damping{Floats(0.f), Floats(0.f), Floats(0.f)};
      if constexpr (kDamped) {
        const BentQuads<kFour, true> moved = at.since({b.start, block, lane});
        damping = bent(b, i, lane, at, moved, d, moved.sum(block, lane));
      }
      if constexpr (kFolded) {
        const Floats of_damping = (Floats(0.f) - stiffness) * Floats(b.damping);
        const FloatVector bent = kCurved ? curved(block, lane, d) : d;
        Hinge(b, i, lane, at, d).pull(to, block, lane, bent, of_damping * damping, b.resolved);
      } else {
        FloatVector f = d;
        if constexpr (kCurved) f = curved(block, lane, d);
        if constexpr (kDamped) f = fused(Floats(b.damping), damping, f);
        pull_quads<kFour>(to, block, lane, (Floats(0.f) - stiffness) * f);
      }
    }
  }
}

/// (|d| - rest)^2 k / 2, or that of folded hinges, of what is stiffer than a substep resolves as if
/// it were just resolved. The lanes of a block are added up one after the other, whatever the width
/// of a vector.
template <bool kFour, bool kFolded>
[[gnu::always_inline]] inline void measure_energies(const Bending& b, double* energy,
                                                    std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    const BendingBlock& block = b.blocks[i];
    alignas(64) float of_lane[kernels::kLanes];
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      const BentQuads<kFour> at(b.u, block, lane);
      const FloatVector d = load_span(b.spans.d[i], lane) + at.sum(block, lane);
      const Floats part = xsimd::min(Floats(1.f), Floats(b.resolved) * load(block.softness + lane));
      const Floats half = Floats(0.5f) * part * load(block.stiffness + lane);
      const Floats bent = xsimd::sqrt(dot(d, d)) - load(block.rest + lane);
      Floats energies = half * bent * bent;
      if constexpr (kFolded) {
        const Hinge hinge(b, i, lane, at, d);
        energies = xsimd::select(hinge.fold == Floats(0.f), energies, half * hinge.bent_square());
      }
      energies.store_unaligned(of_lane + lane);
    }
    energy[i] = 0;
    for (const float e : of_lane) energy[i] += static_cast<double>(e);
  }
}

template <bool kFour, bool kCurved>
[[gnu::always_inline]] inline void pull_elements(const Bending& b, float* to, std::size_t first,
                                                 std::size_t last) {
  const auto pull = [&]<bool kFolded>() {
    if (b.damping > 0) return pull_elements<kFour, kCurved, true, kFolded>(b, to, first, last);
    pull_elements<kFour, kCurved, false, kFolded>(b, to, first, last);
  };
  if constexpr (kFour) {
    if (b.folds != nullptr) return pull.template operator()<true>();
  }
  pull.template operator()<false>();
}
template <bool kFour>
[[gnu::always_inline]] inline void pull_elements(const Bending& b, float* to, std::size_t first,
                                                 std::size_t last) {
  if (b.curved) return pull_elements<kFour, true>(b, to, first, last);
  pull_elements<kFour, false>(b, to, first, last);
}

template <bool kFour>
[[gnu::always_inline]] inline void measure_elements(const BendingBlock* blocks,
                                                    const BendingSpans& spans, const float* base,
                                                    std::size_t first, std::size_t last) {
  if (spans.across != nullptr)
    return measure_elements<kFour, true>(blocks, spans, base, first, last);
  measure_elements<kFour, false>(blocks, spans, base, first, last);
}

void measure_bending(const BendingBlock* blocks, const BendingSpans& spans, const float* base,
                     bool four, std::size_t first, std::size_t last) {
  if (four) return measure_elements<true>(blocks, spans, base, first, last);
  measure_elements<false>(blocks, spans, base, first, last);
}
void pull_bending(const Bending& b, float* to, bool four, std::size_t first, std::size_t last) {
  if (four) return pull_elements<true>(b, to, first, last);
  pull_elements<false>(b, to, first, last);
}

void bending_energy(const Bending& b, double* energy, bool four, std::size_t first,
                    std::size_t last) {
  if (!four) return measure_energies<false, false>(b, energy, first, last);
  if (b.folds != nullptr) return measure_energies<true, true>(b, energy, first, last);
  measure_energies<true, false>(b, energy, first, last);
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
