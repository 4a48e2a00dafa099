/// Anchors in lanes: reference::hold (kernels/reference/anchors.h), which has the formulas.
///
/// A block is kLanes particles that stand in a row of memory, in quads or in a woven row; those
/// without an anchor have no limit. So nothing is gathered, and blocks without a particle at its
/// limit, most of them, are read and left.
#pragma once

#include "kernels/simd/in_rows.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// Takes the part that leads out along the unit vector.
[[gnu::always_inline]] inline FloatVector without(const FloatVector& v, Floats outwards,
                                                  const FloatVector& unit) {
  return fused(Floats(0.f) - xsimd::max(outwards, Floats(0.f)), unit, v);
}

/// The particles of a block and their anchors in the present substep.
struct HeldLanes {
  FloatVector x, v;           // where they are, and their settled velocities
  FloatVector point, motion;  // and its velocity
  Floats most;
  FloatMask at_limit;
};

[[gnu::always_inline]] inline void hold_in_ball(HeldLanes& p, const FloatVector& y, FloatMask out) {
  FloatVector unit = over_length(y) * y;
  p.x = select(out, fused(p.most, unit, p.point), p.x);
  FloatVector on = without(p.v, dot(unit, p.v - p.motion), unit);
  on = select(p.most > Floats(0.f), on, p.motion);
  p.v = select(out, on, p.v);
}

/// A backstop as particles at x see it.
struct BackstopLanes {
  FloatVector normal;
  Floats distance, curvature;
  FloatVector w, e;
  Floats g;

  [[gnu::always_inline]] BackstopLanes(const BackstopBlock& b, std::uint32_t lane, Floats share,
                                       const FloatVector& point, const FloatVector& x) {
    normal = fused(share, load(b.turn, lane), load(b.normal, lane));
    normal = over_length(normal) * normal;
    distance = load(b.distance + lane);
    curvature = load(b.curvature + lane);
    w = fused(distance, normal, x - point);
    e = fused(curvature, w, normal);
    g = fused(Floats(0.5f) * curvature, dot(w, w), dot(normal, w));
  }
};

[[gnu::always_inline]] inline void push_out(HeldLanes& p, const BackstopLanes& b,
                                            const FloatVector& turning, FloatMask under) {
  const Floats none(0.f), one(1.f), near(1e-6f);
  const Floats size = xsimd::sqrt(xsimd::max(none, fused(Floats(2.f) * b.curvature, b.g, one)));
  const Floats over_size = one / xsimd::max(size, near);
  FloatVector unit = select(size > near, over_size * b.e, b.normal);
  FloatVector surface = fused(none - b.distance, turning, p.motion);
  const Floats inwards = dot(unit, surface - p.v) - dot(b.w, turning) * over_size;
  const Floats depth = Floats(-2.f) * b.g / (one + size);
  p.x = select(under, fused(depth, unit, p.x), p.x);
  p.v = select(under, fused(xsimd::max(inwards, none), unit, p.v), p.v);
}

/// Lanes that the backstop has pushed out of the ball.
[[gnu::always_inline]] inline void put_onto_rim(HeldLanes& p, const BackstopLanes& b,
                                                FloatMask beyond) {
  const Floats none(0.f), one(1.f), k = b.curvature, d = b.distance;
  const Floats square = p.most * p.most;
  const Floats z = Floats(0.5f) * k * fused_from(p.most, p.most, d * d) / fused(k, d, one);
  const Floats radius = xsimd::sqrt(xsimd::max(none, fused_from(z - d, z - d, square)));
  FloatVector w = fused(d, b.normal, p.x - p.point);
  FloatVector across = fused(none - dot(w, b.normal), b.normal, w);
  FloatVector rim = fused(z - d, b.normal, p.point);
  rim = fused(radius * over_length(across), across, rim);
  p.x = select(beyond, rim, p.x);
}

/// Lanes on the rim, whose velocity was v (reference::along_rim).
[[gnu::always_inline]] inline void lead_along_rim(HeldLanes& p, const BackstopLanes& b,
                                                  const FloatVector& turning, const FloatVector& v,
                                                  FloatMask beyond) {
  const Floats none(0.f), one(1.f), near(1e-6f), parallel(0.01f);
  const Floats size = xsimd::sqrt(xsimd::max(none, fused(Floats(2.f) * b.curvature, b.g, one)));
  const Floats over_size = one / xsimd::max(size, near);
  FloatVector u = p.x - p.point;
  u = over_length(u) * u;
  FloatVector n = select(size > near, over_size * b.e, b.normal);
  FloatVector surface = fused(none - b.distance, turning, p.motion);
  const Floats out = dot(u, v - p.motion);
  const Floats in = dot(n, surface - v) - dot(b.w, turning) * over_size;
  const Floats cosine = dot(u, n);
  const Floats both =
      fused(cosine, in, out) / xsimd::max(fused_from(cosine, cosine, one), parallel);
  const Floats pushed = xsimd::max(none, fused(cosine, xsimd::max(none, both), in));
  const Floats pulled = xsimd::max(none, fused(cosine, pushed, out));
  FloatVector along = fused(pushed, n, v);
  along = fused(none - pulled, u, along);
  p.v = select(beyond && (p.most > none), along, p.v);
}

[[gnu::always_inline]] inline void hold_behind(HeldLanes& p, const BackstopBlock& block,
                                               const AnchorSolve& h, const FloatVector& settled,
                                               std::uint32_t lane) {
  const Floats share(h.share);
  const BackstopLanes b(block, lane, share, p.point, p.x);
  const FloatMask under = b.g < Floats(0.f);
  if (bits(under) == 0) return;
  p.at_limit = p.at_limit || under;
  FloatVector turning = Floats(h.per_second) * load(block.turn, lane);
  push_out(p, b, turning, under);
  FloatVector y = p.x - p.point;
  const Floats square = p.most * p.most, rounding(1 + 2e-6f);
  const FloatMask beyond = under && (dot(y, y) > rounding * square);
  if (bits(beyond) == 0) return;
  put_onto_rim(p, b, beyond);
  const BackstopLanes there(block, lane, share, p.point, p.x);
  lead_along_rim(p, there, turning, settled, beyond);
}

template <class At>
[[gnu::always_inline]] inline void hold_block(const AnchorSolve& h, std::size_t i, At at) {
  const AnchorBlock& block = h.blocks[i];
  const BackstopBlock* backstop = block.backstop < 0 ? nullptr : h.backstops + block.backstop;
  const Flight& f = h.flight;
  std::uint32_t on = 0, moved = 0;
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    HeldLanes p;
    p.x = at.get(f.u, block.place, lane);
    p.point = fused(Floats(h.share), load(block.way, lane), load(block.point, lane));
    p.most = load(block.most + lane);
    FloatVector from = p.x, y = p.x - p.point;
    const FloatMask out = dot(y, y) >= p.most * p.most;
    if (backstop == nullptr && bits(out) == 0) continue;
    FloatVector predicted = at.get(f.predicted, block.place, lane);
    FloatVector v = at.get(f.v, block.place, lane);
    FloatVector led_to = at.get(f.led_to, block.place, lane);
    p.v = fused(Floats(h.rate), led_to - predicted, v);
    p.motion = Floats(h.per_second) * load(block.way, lane);
    p.at_limit = out;
    FloatVector settled = p.v;
    hold_in_ball(p, y, out);
    if (backstop != nullptr) hold_behind(p, *backstop, h, settled, lane);
    if (bits(p.at_limit) == 0) continue;
    at.put(f.u, block.place, lane, p.x);
    if (!f.is_mended()) led_to = p.x;
    at.put(f.predicted, block.place, lane, select(p.at_limit, led_to, predicted));
    at.put(f.v, block.place, lane, select(p.at_limit, p.v, v));
    FloatVector by = p.x - from;
    on |= bits(p.at_limit) << lane;
    moved |= bits(dot(by, by) > load(block.far + lane)) << lane;
  }
  h.at_limit[i] = static_cast<std::uint16_t>(on);
  h.moved[i] = static_cast<std::uint16_t>(moved);
}

void hold_anchors(const AnchorSolve& hold, std::size_t first, std::size_t last) {
  const AnchorSolve h = hold;
  for (std::size_t i = first; i < last; ++i) {
    if (h.woven)
      hold_block(h, i, InWovenRow{});
    else
      hold_block(h, i, InQuads{});
  }
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
