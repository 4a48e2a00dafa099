/// Triangles of fabric in lanes (kernels/reference/membrane.h has the formulas). A visit reads the
/// deformation of an element from its corners,
///
///     f_u = span_u + u_1 (x_1 - x_0) + u_2 (x_2 - x_0),   f_v likewise,
///
/// span being the same sum over the base; then warp, weft and shear change f_u and f_v one after
/// the other, and corners are moved once, by the sum of the three impulses.
///
/// Each law needs what the one before it made of f, so the laws of one vector of elements are a
/// long chain of operations that wait for each other. Therefore a visit takes a strip of blocks
/// through one law after the other: while one vector waits, others are worked on. A small buffer
/// passes values from one law to the next.
///
/// Inverse masses are over W, the larger one of W_uu and W_vv, and multipliers and stiffnesses
/// times W: so impulses are strains, whatever the masses and the size of a triangle.
#pragma once

#include <algorithm>

#include "kernels/simd/quads.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

struct DeformationLanes {
  FloatVector u, v;
};

/// The deformation of a block's lanes from `lane` on, as far as it comes from the quads `from`.
[[gnu::always_inline]] inline DeformationLanes deformation_from(const float* from,
                                                                const MembraneBlock& block,
                                                                std::uint32_t lane) {
  Floats d1[4], d2[4];
#pragma GCC unroll 4
  for (std::uint32_t k = 0; k < 4; ++k) {
    const Floats x0 = load_quads(from, QuadPlaces{block.place[0] + lane + k});
    d1[k] = load_quads(from, QuadPlaces{block.place[1] + lane + k}) - x0;
    d2[k] = load_quads(from, QuadPlaces{block.place[2] + lane + k}) - x0;
  }
  FloatVector to_1 = transposed(d1[0], d1[1], d1[2], d1[3]);
  FloatVector to_2 = transposed(d2[0], d2[1], d2[2], d2[3]);
  return {fused(load(block.u[0] + lane), to_1, load(block.u[1] + lane) * to_2),
          fused(load(block.v[0] + lane), to_1, load(block.v[1] + lane) * to_2)};
}
[[gnu::always_inline]] inline DeformationLanes load(const MembraneSpans& spans,
                                                    std::uint32_t lane) {
  return {load(spans.u, lane), load(spans.v, lane)};
}
[[gnu::always_inline]] inline void store(MembraneSpans& spans, std::uint32_t lane,
                                         const DeformationLanes& f) {
  store(spans.u, lane, f.u);
  store(spans.v, lane, f.v);
}

void measure_membrane(const MembraneBlock* blocks, MembraneSpans* spans, const float* base,
                      std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats)
      store(spans[i], lane, deformation_from(base, blocks[i], lane));
  }
}

[[gnu::always_inline]] inline DeformationLanes deformation_at(const Membrane& m, const float* u,
                                                              std::size_t i, std::uint32_t lane) {
  DeformationLanes moved = deformation_from(u, m.blocks[i], lane);
  return {load(m.spans[i].u, lane) + moved.u, load(m.spans[i].v, lane) + moved.v};
}

[[gnu::always_inline]] inline Floats length_of(const FloatVector& f) {
  const Floats tiny(1e-30f);
  return xsimd::sqrt(fused(f.x, f.x, fused(f.y, f.y, fused(f.z, f.z, tiny))));
}

/// The angle between the directions of warp and weft.
struct AngleLanes {
  Floats uu, uv, vv;  // products of f_u and f_v
  Floats area;        // |f_u|^2 |f_v|^2
  Floats over;        // 1 / (|f_u| |f_v|)

  [[gnu::always_inline]] static AngleLanes of(const DeformationLanes& f) {
    AngleLanes angle;
    angle.uu = dot(f.u, f.u);
    angle.vv = dot(f.v, f.v);
    angle.uv = dot(f.u, f.v);
    angle.area = xsimd::max(angle.uu * angle.vv, Floats(1e-12f));
    angle.over = Floats(1.f) / xsimd::sqrt(angle.area);
    return angle;
  }
  [[gnu::always_inline]] Floats cosine() const { return over * uv; }
};

/// The left sides of the laws when the substep began: |f_u|, |f_v| and the cosine of their angle.
struct MembraneStart {
  Floats value[3];

  [[gnu::always_inline]] static MembraneStart of(const DeformationLanes& f) {
    return {{length_of(f.u), length_of(f.v), AngleLanes::of(f).cosine()}};
  }
};

/// The values of a strip of blocks between two laws, at the places of its lanes.
struct alignas(64) MembraneStrip {
  static constexpr std::size_t kBlocks = 4;

  MembraneSpans f[kBlocks];
  MembraneSpans push[kBlocks];  // impulses of warp along f_u, of weft along f_v
  // What shear adds to push: across f_v - along_u f_u, and across f_u - along_v f_v.
  LaneVectors shear[kBlocks];  // across, along_u, along_v
  LaneVectors start[kBlocks];  // MembraneStart
};

/// A sweep's visits. Their common data are loaded once, since these stand apart from the strip, to
/// which they store.
template <bool kRope, bool kDamped>
struct MembraneVisit {
  const Membrane m;
  const Floats give, damping, looseness, half;  // looseness: (1 + damping) / omega; half: of omega
  const bool continues;
  MembraneStrip& strip;

  [[gnu::always_inline]] MembraneVisit(const Membrane& membrane, float omega, bool goes_on,
                                       MembraneStrip& between)
      : m(membrane),
        give(membrane.give),
        damping(membrane.damping),
        looseness((1 + membrane.damping) / omega),
        half(0.5f * omega),
        continues(goes_on),
        strip(between) {}

  /// k: of block i in the strip.
  [[gnu::always_inline]] void begin(std::size_t i, std::size_t k, std::uint32_t lane) {
    if constexpr (kDamped) {
      const MembraneStart s = MembraneStart::of(deformation_at(m, m.u_start, i, lane));
      store(strip.start[k], lane, {s.value[0], s.value[1], s.value[2]});
    }
    DeformationLanes f = deformation_at(m, m.u, i, lane);
    FloatVector push = relax_stretch<0>(i, lane, strip.start[k].x + lane, f.u, f.v);
    store(strip.f[k], lane, f);
    store(strip.push[k].u, lane, push);
  }
  [[gnu::always_inline]] void weft(std::size_t i, std::size_t k, std::uint32_t lane) {
    DeformationLanes f = load(strip.f[k], lane);
    FloatVector push = relax_stretch<1>(i, lane, strip.start[k].y + lane, f.v, f.u);
    store(strip.f[k], lane, f);
    store(strip.push[k].v, lane, push);
  }

  /// The law's impulse is p = (s C - mu) / max(q, omega q / 2 + 1), q = s looseness w, w being the
  /// inverse mass (reference::MembraneLaw); here both sides of the fraction are times |f_u|^2
  /// |f_v|^2, so that w needs no quotient.
  [[gnu::always_inline]] void shear(std::size_t i, std::size_t k, std::uint32_t lane) {
    const MembraneBlock& block = m.blocks[i];
    AngleLanes angle = AngleLanes::of(load(strip.f[k], lane));
    Floats error = angle.cosine();
    if constexpr (kDamped) error = fused(damping, error - load(strip.start[k].z + lane), error);
    const Floats size =
        fused(load(block.mobility[0] + lane), angle.vv, load(block.mobility[2] + lane) * angle.uu);
    const Floats inverse_mass =
        xsimd::max(fused_from(angle.uv + angle.uv, load(block.mobility[1] + lane), size),
                   Floats(0x1p-20f) * size);
    const Floats stiffness = give * load(block.stiffness[2] + lane);
    const Floats own = stiffness * looseness * inverse_mass;
    const Floats share = angle.area / xsimd::max(own, fused(own, half, angle.area));
    const Floats before = multiplier(2, i, lane);
    const Floats impulse = fused(stiffness, error, Floats(0.f) - before) * share;
    keep_multiplier(2, i, lane, before + impulse);
    const Floats along = angle.cosine() * (angle.over * angle.over);
    store(strip.shear[k], lane,
          {impulse * angle.over, impulse * (along * angle.vv), impulse * (along * angle.uu)});
  }

  [[gnu::always_inline]] void move_corners(std::size_t i, std::size_t k, std::uint32_t lane) {
    const MembraneBlock& block = m.blocks[i];
    DeformationLanes f = load(strip.f[k], lane), push = load(strip.push[k], lane);
    FloatVector shear = load(strip.shear[k], lane);
    push.u = fused_from(shear.y, f.u, fused(shear.x, f.v, push.u));
    push.v = fused_from(shear.z, f.v, fused(shear.x, f.u, push.v));
#pragma GCC unroll 3
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Quads by = transposed(fused(load(block.share_u[corner] + lane), push.u,
                                        load(block.share_v[corner] + lane) * push.v));
      const std::uint32_t* const place = block.place[corner] + lane;
      subtract_quads(m.u, QuadPlaces{place}, by.q0);
      subtract_quads(m.u, QuadPlaces{place + 1}, by.q1);
      subtract_quads(m.u, QuadPlaces{place + 2}, by.q2);
      subtract_quads(m.u, QuadPlaces{place + 3}, by.q3);
    }
  }

 private:
  [[gnu::always_inline]] Floats multiplier(std::size_t law, std::size_t i,
                                           std::uint32_t lane) const {
    if (!continues) return Floats(0.f);
    return load(m.multiplier + (3 * i + law) * kernels::kLanes + lane);
  }
  [[gnu::always_inline]] void keep_multiplier(std::size_t law, std::size_t i, std::uint32_t lane,
                                              Floats to) const {
    to.store_unaligned(m.multiplier + (3 * i + law) * kernels::kLanes + lane);
  }

  /// Law 0 or 1, of the direction whose vector is f; the other one's moves along with it. Returns
  /// the impulse, along f.
  template <std::size_t kLaw>
  [[gnu::always_inline]] FloatVector relax_stretch(std::size_t i, std::uint32_t lane,
                                                   const float* start_length, FloatVector& f,
                                                   FloatVector& other) const {
    const MembraneBlock& block = m.blocks[i];
    const Floats length = length_of(f);
    Floats error = length - Floats(1.f);
    if constexpr (kDamped) error = fused(damping, length - load(start_length), error);
    const Floats stiffness = give * load(block.stiffness[kLaw] + lane);
    const Floats mobility = load(block.mobility[2 * kLaw] + lane);
    const Floats before = multiplier(kLaw, i, lane);
    const Floats own = stiffness * looseness * mobility;
    const Floats divisor = xsimd::max(own, fused(own, half, Floats(1.f)));
    Floats lack = fused(stiffness, error, Floats(0.f) - before);
    if constexpr (kRope) lack = xsimd::max(lack, Floats(0.f) - before * divisor);
    const Floats along = lack / (divisor * length);  // the impulse over |f|
    keep_multiplier(kLaw, i, lane, fused(along, length, before));
    FloatVector push = along * f;
    other = fused_from(along * load(block.mobility[1] + lane), f, other);
    f = fused_from(along * mobility, f, f);
    return push;
  }
};

/// work(i, i - first, lane) for the vectors of blocks first ... last - 1.
template <class Work>
[[gnu::always_inline]] inline void for_vectors(std::size_t first, std::size_t last, Work&& work) {
  for (std::size_t i = first; i < last; ++i) {
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) work(i, i - first, lane);
  }
}

template <bool kRope, bool kDamped>
[[gnu::always_inline]] inline void relax_elements(const Membrane& membrane, float omega,
                                                  bool continues, std::size_t first,
                                                  std::size_t last) {
  MembraneStrip strip;
  MembraneVisit<kRope, kDamped> visit(membrane, omega, continues, strip);
  for (std::size_t from = first; from < last; from += MembraneStrip::kBlocks) {
    const std::size_t to = std::min(from + MembraneStrip::kBlocks, last);
    for_vectors(
        from, to, [&](auto... at) __attribute__((always_inline)) { visit.begin(at...); });
    for_vectors(
        from, to, [&](auto... at) __attribute__((always_inline)) { visit.weft(at...); });
    for_vectors(
        from, to, [&](auto... at) __attribute__((always_inline)) { visit.shear(at...); });
    for_vectors(
        from, to, [&](auto... at) __attribute__((always_inline)) { visit.move_corners(at...); });
  }
}

/// Whether a law is broken by more than the strain. One without stiffness is none.
template <bool kRope>
[[gnu::always_inline]] inline FloatMask is_broken(Floats stiffness, Floats error, Floats multiplier,
                                                  Floats strain) {
  Floats lack = stiffness * error - multiplier;
  if constexpr (kRope) lack = xsimd::max(lack, Floats(0.f) - multiplier);
  return xsimd::abs(lack) > strain * stiffness;
}

template <bool kRope, bool kDamped>
[[gnu::always_inline]] inline void judge_elements(const Membrane& membrane, float tolerance,
                                                  std::uint16_t* out, std::size_t first,
                                                  std::size_t last) {
  const Membrane m = membrane;  // Stores could be to what references lead to.
  const Floats give(m.give), damping(m.damping), strain(tolerance), one(1.f);
  for (std::size_t i = first; i < last; ++i) {
    std::uint32_t lanes = 0;
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      MembraneStart now = MembraneStart::of(deformation_at(m, m.u, i, lane));
      Floats error[3] = {now.value[0] - one, now.value[1] - one, now.value[2]};
      if constexpr (kDamped) {
        MembraneStart start = MembraneStart::of(deformation_at(m, m.u_start, i, lane));
        for (std::size_t k = 0; k < 3; ++k)
          error[k] = fused(damping, now.value[k] - start.value[k], error[k]);
      }
      const auto broken = [&]<bool kOneSided>(std::size_t k) __attribute__((always_inline)) {
        const float* const multiplier = m.multiplier + (3 * i + k) * kernels::kLanes + lane;
        return bits(is_broken<kOneSided>(give * load(m.blocks[i].stiffness[k] + lane), error[k],
                                         load(multiplier), strain));
      };
      lanes |= (broken.template operator()<kRope>(0) | broken.template operator()<kRope>(1) |
                broken.template operator()<false>(2))
               << lane;
    }
    out[i] = static_cast<std::uint16_t>(lanes);
  }
}

template <bool kRope>
[[gnu::always_inline]] inline void relax_elements(const Membrane& m, float omega, bool continues,
                                                  std::size_t first, std::size_t last) {
  if (m.damping > 0) return relax_elements<kRope, true>(m, omega, continues, first, last);
  relax_elements<kRope, false>(m, omega, continues, first, last);
}
template <bool kRope>
[[gnu::always_inline]] inline void judge_elements(const Membrane& m, float strain,
                                                  std::uint16_t* out, std::size_t first,
                                                  std::size_t last) {
  if (m.damping > 0) return judge_elements<kRope, true>(m, strain, out, first, last);
  judge_elements<kRope, false>(m, strain, out, first, last);
}

void relax_membrane(const Membrane& m, float omega, bool continues, bool rope, std::size_t first,
                    std::size_t last) {
  if (rope) return relax_elements<true>(m, omega, continues, first, last);
  relax_elements<false>(m, omega, continues, first, last);
}
void judge_membrane(const Membrane& m, float strain, std::uint16_t* out, bool rope,
                    std::size_t first, std::size_t last) {
  if (rope) return judge_elements<true>(m, strain, out, first, last);
  judge_elements<false>(m, strain, out, first, last);
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
