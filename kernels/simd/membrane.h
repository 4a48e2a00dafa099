/// Triangles of fabric in lanes (kernels/reference/membrane.h has the formulas). A visit reads the
/// deformation of an element from its corners,
///
///     f_u = span_u + u_1 (x_1 - x_0) + u_2 (x_2 - x_0),   f_v likewise,
///
/// span being the same sum over the base; then warp, weft and shear change f_u and f_v one after
/// the other in registers, and corners are moved once, by the sum of the three impulses.
///
/// Inverse masses are over W, the larger one of W_uu and W_vv, and multipliers and stiffnesses
/// times W: so impulses are strains, whatever the masses and the size of a triangle.
#pragma once

#include "kernels/simd/quads.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

struct DeformationLanes {
  FloatVector u, v;
};

/// Of a block's lanes from `lane` on.
struct CornerQuads {
  FloatVector x[3];

  [[gnu::always_inline]] CornerQuads(const float* from, const MembraneBlock& block,
                                     std::uint32_t lane) {
    for (std::size_t k = 0; k < 3; ++k) x[k] = QuadLanes{}.get(from, block.slot[k] + lane);
  }
  [[gnu::always_inline]] DeformationLanes deformation(const MembraneBlock& block,
                                                      std::uint32_t lane) const {
    FloatVector d1 = x[1] - x[0], d2 = x[2] - x[0];
    return {fused(load(block.u[0] + lane), d1, load(block.u[1] + lane) * d2),
            fused(load(block.v[0] + lane), d1, load(block.v[1] + lane) * d2)};
  }
  [[gnu::always_inline]] void move(float* to, const MembraneBlock& block, std::uint32_t lane,
                                   const DeformationLanes& push) {
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = fused_from(load(block.share_u[k] + lane), push.u, x[k]);
      x[k] = fused_from(load(block.share_v[k] + lane), push.v, x[k]);
      QuadLanes{}.put(to, block.slot[k] + lane, x[k]);
    }
  }
};

void measure_membrane(const MembraneBlock* blocks, MembraneSpans* spans, const float* base,
                      std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      DeformationLanes f = CornerQuads(base, blocks[i], lane).deformation(blocks[i], lane);
      store(spans[i].u, lane, f.u);
      store(spans[i].v, lane, f.v);
    }
  }
}

/// |f|, and by how much it is off 1, damped.
struct LengthLanes {
  Floats length, error;

  template <bool kDamped>
  [[gnu::always_inline]] static LengthLanes at(const FloatVector& f, const FloatVector& start,
                                               Floats damping) {
    const Floats tiny(1e-30f);
    LengthLanes s;
    s.length = xsimd::sqrt(dot(f, f) + tiny);
    s.error = s.length - Floats(1.f);
    if constexpr (kDamped)
      s.error = fused(damping, s.length - xsimd::sqrt(dot(start, start) + tiny), s.error);
    return s;
  }
};

/// The cosine of the angle between the directions, what it is made of, and it damped.
struct AngleLanes {
  Floats over, u, v;  // 1 / (|f_u| |f_v|), and of 1 / |f_u|^2, 1 / |f_v|^2
  Floats cosine, error;

  template <bool kDamped>
  [[gnu::always_inline]] static AngleLanes at(const DeformationLanes& f,
                                              const DeformationLanes& start, Floats damping) {
    AngleLanes s;
    const Floats uu = dot(f.u, f.u), vv = dot(f.v, f.v);
    s.over = over_product(uu, vv);
    s.cosine = s.error = s.over * dot(f.u, f.v);
    s.u = vv * s.over * s.over;
    s.v = uu * s.over * s.over;
    if constexpr (kDamped) {
      const Floats over_start = over_product(dot(start.u, start.u), dot(start.v, start.v));
      s.error = fused(damping, s.cosine - over_start * dot(start.u, start.v), s.error);
    }
    return s;
  }

 private:
  [[gnu::always_inline]] static Floats over_product(Floats uu, Floats vv) {
    return Floats(1.f) / xsimd::sqrt(xsimd::max(uu * vv, Floats(1e-12f)));
  }
};

/// An element of a block: its deformation, the multipliers of warp, weft and shear, and their
/// stiffnesses times (b h)^2.
template <bool kDamped>
struct ElementLanes {
  DeformationLanes f, start;
  Floats multiplier[3], stiffness[3];

  [[gnu::always_inline]] ElementLanes(const Membrane& m, const CornerQuads& corners, std::size_t i,
                                      std::uint32_t lane) {
    const MembraneBlock& block = m.blocks[i];
    f = corners.deformation(block, lane);
    f = {load(m.spans[i].u, lane) + f.u, load(m.spans[i].v, lane) + f.v};
    start = {no_vector(), no_vector()};
    if constexpr (kDamped) {
      start = CornerQuads(m.u_start, block, lane).deformation(block, lane);
      start = {load(m.spans[i].u, lane) + start.u, load(m.spans[i].v, lane) + start.v};
    }
    const float* const from = m.multiplier + 3 * kernels::kLanes * i + lane;
    for (std::size_t k = 0; k < 3; ++k) {
      multiplier[k] = load(from + k * kernels::kLanes);
      stiffness[k] = Floats(m.give) * load(block.stiffness[k] + lane);
    }
  }
};

/// What the visits of a sweep have in common.
struct MembraneSweep {
  Floats damping, looseness;  // looseness: (1 + damping) / omega
};

/// The law of one direction, whose vector is f; the other one's moves by `cross` of what f does.
/// push is along f.
template <bool kRope, bool kDamped>
[[gnu::always_inline]] inline void relax_stretch(const MembraneSweep& s, Floats stiffness,
                                                 Floats mobility, Floats cross, FloatVector& f,
                                                 FloatVector& other, const FloatVector& start,
                                                 Floats& multiplier, FloatVector& push) {
  const LengthLanes law = LengthLanes::at<kDamped>(f, start, s.damping);
  Floats lack = stiffness * law.error - multiplier;
  const Floats divisor = fused(stiffness * s.looseness, mobility, Floats(1.f));
  if constexpr (kRope) lack = xsimd::max(lack, Floats(0.f) - multiplier * divisor);
  const Floats along = lack / (divisor * law.length);  // the impulse over |f|
  multiplier = fused(along, law.length, multiplier);
  push = fused(along, f, push);
  other = fused_from(along * cross, f, other);
  f = fused_from(along * mobility, f, f);
}

/// mobility: W_uu, W_uv and W_vv.
template <bool kDamped>
[[gnu::always_inline]] inline void relax_shear(const MembraneSweep& s, Floats stiffness,
                                               const Floats* mobility, const DeformationLanes& f,
                                               const DeformationLanes& start, Floats& multiplier,
                                               DeformationLanes& push) {
  const AngleLanes law = AngleLanes::at<kDamped>(f, start, s.damping);
  const Floats size = fused(mobility[0], law.u, mobility[2] * law.v);
  const Floats twice = (law.cosine + law.cosine) * law.over;
  const Floats inverse = xsimd::max(fused_from(twice, mobility[1], size), Floats(0x1p-20f) * size);
  const Floats impulse =
      (stiffness * law.error - multiplier) / fused(stiffness * s.looseness, inverse, Floats(1.f));
  multiplier = multiplier + impulse;
  const Floats across = impulse * law.over, along = impulse * law.cosine;
  push.u = fused_from(along * law.u, f.u, fused(across, f.v, push.u));
  push.v = fused_from(along * law.v, f.v, fused(across, f.u, push.v));
}

template <bool kRope, bool kDamped>
[[gnu::always_inline]] inline void relax_elements(const Membrane& membrane, float omega,
                                                  bool continues, std::size_t first,
                                                  std::size_t last) {
  const Membrane m = membrane;  // Stores could be to what references lead to.
  const MembraneSweep sweep{Floats(m.damping), Floats((1 + m.damping) / omega)};
  for (std::size_t i = first; i < last; ++i) {
    const MembraneBlock& block = m.blocks[i];
    float* const multipliers = m.multiplier + 3 * kernels::kLanes * i;
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      CornerQuads corners(m.u, block, lane);
      ElementLanes<kDamped> e(m, corners, i, lane);
      Floats mobility[3];
      for (std::size_t k = 0; k < 3; ++k) {
        mobility[k] = load(block.mobility[k] + lane);
        if (!continues) e.multiplier[k] = Floats(0.f);
      }
      DeformationLanes push{no_vector(), no_vector()};
      relax_stretch<kRope, kDamped>(sweep, e.stiffness[0], mobility[0], mobility[1], e.f.u, e.f.v,
                                    e.start.u, e.multiplier[0], push.u);
      relax_stretch<kRope, kDamped>(sweep, e.stiffness[1], mobility[2], mobility[1], e.f.v, e.f.u,
                                    e.start.v, e.multiplier[1], push.v);
      relax_shear<kDamped>(sweep, e.stiffness[2], mobility, e.f, e.start, e.multiplier[2], push);
      for (std::size_t k = 0; k < 3; ++k)
        e.multiplier[k].store_unaligned(multipliers + k * kernels::kLanes + lane);
      corners.move(m.u, block, lane, push);
    }
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
  const Membrane m = membrane;
  const Floats damping(m.damping), strain(tolerance);
  for (std::size_t i = first; i < last; ++i) {
    std::uint32_t lanes = 0;
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      const ElementLanes<kDamped> e(m, CornerQuads(m.u, m.blocks[i], lane), i, lane);
      const Floats warp = LengthLanes::at<kDamped>(e.f.u, e.start.u, damping).error;
      const Floats weft = LengthLanes::at<kDamped>(e.f.v, e.start.v, damping).error;
      const Floats shear = AngleLanes::at<kDamped>(e.f, e.start, damping).error;
      lanes |= (bits(is_broken<kRope>(e.stiffness[0], warp, e.multiplier[0], strain)) |
                bits(is_broken<kRope>(e.stiffness[1], weft, e.multiplier[1], strain)) |
                bits(is_broken<false>(e.stiffness[2], shear, e.multiplier[2], strain)))
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
