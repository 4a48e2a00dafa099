/// Particles against bodies in lanes: reference::solve_contact (kernels/reference/bodies.h), which
/// has the formulas. A pair is a block of particles (in_rows.h) and a body that may be near to it;
/// blocks without a contact are read and left. Particles whose way is long beside a round form are
/// left to the reference.
#pragma once

#include "kernels/reference/bodies.h"
#include "kernels/simd/fields.h"
#include "kernels/simd/in_rows.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

[[gnu::always_inline]] inline FloatVector splat(const float* v) {
  return {Floats(v[0]), Floats(v[1]), Floats(v[2])};
}

/// kFloats particles of a block beside a body.
struct TouchLanes {
  FloatVector x, start;  // from the frame's origin
  FloatVector slip;
  FloatVector normal;
  Floats gap;
  FloatMask near;
};

/// By the gap at its end.
[[gnu::always_inline]] inline void touch_round(TouchLanes& p, const BodyFrame& f, Floats radius) {
  FloatVector axis = splat(f.axis), from_a = p.x - splat(f.a);
  const Floats none(0.f), height = dot(from_a, axis);
  const Floats across =
      xsimd::sqrt(xsimd::max(none, fused_from(height, height, dot(from_a, from_a))));
  Floats at = fused_from(Floats(f.lean), across, height);
  at = xsimd::min(xsimd::max(at, none), Floats(f.length));
  FloatVector d = fused_from(at, axis, from_a);
  const Floats l = xsimd::sqrt(dot(d, d));
  p.gap = l - fused_from(Floats(f.taper), at, Floats(f.radius) + radius);
  p.near = p.gap < none;
  p.normal = (Floats(1.f) / xsimd::max(l, tiny())) * d;
}

[[gnu::always_inline]] inline Floats height_over(const float* face, const FloatVector& x) {
  return fused(
      Floats(face[0]), x.x,
      fused(Floats(face[1]), x.y, fused_from(Floats(1.f), Floats(face[3]), Floats(face[2]) * x.z)));
}

[[gnu::always_inline]] inline void touch_plane(TouchLanes& p, const BodyFrame& f, Floats radius) {
  p.gap = height_over(f.faces[0].to, p.x) - radius;
  p.near = p.gap < Floats(0.f);
  p.normal = splat(f.faces[0].to);
}

/// The face through which a way enters, or, where it begins inside, the one nearest to that: unless
/// it leads up from that one, and out.
[[gnu::always_inline]] inline void touch_hull(TouchLanes& p, const BodyFrame& f, Floats radius) {
  const Floats none(0.f), far(1e30f);
  Floats enters = none - Floats(1.f), leaves = far, nearest = none - far, nearest_gap = none;
  FloatVector entry = no_vector(), last = no_vector();
  Floats entry_gap = none;
  FloatMask outside = none > none, ends_outside = outside;
  for (std::uint32_t k = 0; k < f.face_count; ++k) {
    const BodyFace& face = f.faces[k];
    const Floats g0 = height_over(face.from, p.start) - radius;
    const Floats g1 = height_over(face.to, p.x) - radius;
    const FloatMask began_out = g0 > none, ends_out = g1 > none;
    outside = outside || (began_out && ends_out);
    const Floats at = g0 / (g0 - g1);
    FloatVector normal = splat(face.to);
    const FloatMask later = began_out && !ends_out && at > enters;
    enters = xsimd::select(later, at, enters);
    entry = select(later, normal, entry);
    entry_gap = xsimd::select(later, g1, entry_gap);
    leaves = xsimd::select(ends_out && !began_out, xsimd::min(at, leaves), leaves);
    ends_outside = ends_outside || ends_out;
    const FloatMask nearer = g0 > nearest;
    nearest = xsimd::select(nearer, g0, nearest);
    nearest_gap = xsimd::select(nearer, g1, nearest_gap);
    last = select(nearer, normal, last);
  }
  const FloatMask began_inside = enters < none;
  p.normal = select(began_inside, last, entry);
  p.gap = xsimd::select(began_inside, nearest_gap, entry_gap);
  const FloatMask stays = !ends_outside || nearest_gap < nearest;
  p.near = !outside && ((began_inside && stays) || (!began_inside && enters <= leaves));
}

/// Shortens `along` by what friction may still hold; returns the share.
[[gnu::always_inline]] inline Floats held_share(Floats along, Floats may, Floats& held) {
  const Floats left = xsimd::max(Floats(0.f), may - held);
  const Floats share = xsimd::min(Floats(1.f), left / xsimd::max(along, tiny()));
  held = fused(share, along, held);
  return share;
}

template <class At>
[[gnu::always_inline]] inline TouchLanes begin_touch(const BodySolve& h, const BodyBlock& block,
                                                     const BodyFrame& f, std::uint32_t lane, At at,
                                                     const FloatVector& u) {
  TouchLanes p;
  FloatVector before = at.get(h.flight.u_before, block.place, lane);
  FloatVector moved = u - before;
  p.x = (at.get(h.base, block.place, lane) - splat(f.origin)) + u;
  p.start = p.x - moved;
  FloatVector r = p.start - splat(f.centre_from);
  FloatVector carried = fused(r.x, splat(f.turn), splat(f.way));
  carried = fused(r.y, splat(f.turn + 3), carried);
  carried = fused(r.z, splat(f.turn + 6), carried);
  p.slip = moved - carried;
  const Floats radius = load(block.radius + lane), mass = load(block.mass + lane);
  switch (f.kind) {
    case BodyKind::plane:
      touch_plane(p, f, radius);
      break;
    case BodyKind::hull:
      touch_hull(p, f, radius);
      break;
    case BodyKind::round:
      touch_round(p, f, radius);
      break;
    case BodyKind::field:  // solve_field_pair
      p.near = mass < Floats(0.f);
  }
  p.near = p.near && mass > Floats(0.f);
  return p;
}

/// m, along the normal; 0 where nothing is to be done.
[[gnu::always_inline]] inline Floats push_of(const TouchLanes& p, Floats approach, Floats came_out,
                                             float h) {
  const Floats none(0.f), began = p.gap + approach - came_out;
  using reference::kFastestRecovery, reference::kRecovery, reference::kRecoveryTime;
  const Floats speed = fused_from(Floats(static_cast<float>(1 / kRecoveryTime)), began,
                                  Floats(static_cast<float>(kRecovery)));
  const Floats comes_out =
      Floats(h) * xsimd::min(speed, Floats(static_cast<float>(kFastestRecovery)));
  const Floats target = xsimd::select(began < none, xsimd::min(none, began + comes_out), none);
  return xsimd::select(p.near, xsimd::max(none, target - p.gap), none);
}

[[gnu::always_inline]] inline void add(LaneVectors& sum, std::uint32_t lane, const FloatVector& v) {
  FloatVector before = load(sum, lane);
  store(sum, lane, before + v);
}

template <class At>
[[gnu::always_inline]] inline void solve_pair(const BodySolve& h, std::size_t i, At at) {
  const BodyBlock& block = h.blocks[h.pairs[i].block];
  const BodyFrame& f = h.frames[h.pairs[i].body];
  const Flight& flight = h.flight;
  BodyContactSums& sums = h.sums[i];
  const Floats none(0.f);
  std::uint32_t touching = 0, far = 0, quick = 0;
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    FloatVector u = at.get(flight.u, block.place, lane);
    TouchLanes p = begin_touch(h, block, f, lane, at, u);
    if (f.kind == BodyKind::round) {
      const FloatMask is_quick =
          dot(p.slip, p.slip) > Floats(f.short_way) && load(block.mass + lane) > none;
      quick |= bits(is_quick) << lane;
      p.near = p.near && !is_quick;
    }
    if (bits(p.near) == 0) continue;
    const Floats thinned_by = load(sums.thinned_by + lane), retreat = load(sums.retreat + lane);
    const Floats toward = none - dot(p.normal, p.slip), approach = toward - retreat;
    p.gap = p.gap + thinned_by;
    const Floats came_out = load(sums.came_out + lane);
    const Floats push = push_of(p, approach, came_out, h.h);
    const FloatMask on = push > none;
    if (bits(on) == 0) continue;
    const Floats stays_out = xsimd::min(push, xsimd::max(none, approach));
    const Floats pushed = load(sums.pushed + lane) + stays_out;
    Floats held = load(sums.held + lane);
    FloatVector along = fused(toward, p.normal, p.slip);
    const Floats presses = Floats(static_cast<float>(reference::kPressed)) * thinned_by;
    const Floats most_held = Floats(f.friction) * (pushed + presses);
    const Floats share = held_share(xsimd::sqrt(dot(along, along)), most_held, held);
    FloatVector by = fused_from(share, along, push * p.normal);
    FloatVector predicted = at.get(flight.predicted, block.place, lane);
    FloatVector v_before = at.get(flight.v, block.place, lane);
    FloatVector led_to = at.get(flight.led_to, block.place, lane);
    FloatVector v = fused(Floats(h.rate), led_to - predicted, v_before);

    FloatVector r = (p.x + by) - splat(f.centre_to);
    FloatVector surface = splat(f.velocity) + cross(splat(f.spin), r);
    FloatVector relative = v - surface;
    const Floats out = dot(p.normal, relative);
    const Floats per_second(1.f / h.h);
    const Floats into = xsimd::max(none, none - out - retreat * per_second);
    const Floats stopped = load(sums.stopped + lane) + into;
    Floats slowed = load(sums.slowed + lane);
    FloatVector sliding = fused_from(out, p.normal, relative);
    const Floats square = dot(sliding, sliding);
    const Floats most_slowed = Floats(f.friction) * (stopped + presses * per_second);
    const Floats taken = held_share(xsimd::sqrt(square), most_slowed, slowed);
    FloatVector change = fused_from(taken, sliding, into * p.normal);

    xsimd::select(on, pushed, load(sums.pushed + lane)).store_unaligned(sums.pushed + lane);
    xsimd::select(on, held, load(sums.held + lane)).store_unaligned(sums.held + lane);
    xsimd::select(on, stopped, load(sums.stopped + lane)).store_unaligned(sums.stopped + lane);
    xsimd::select(on, slowed, load(sums.slowed + lane)).store_unaligned(sums.slowed + lane);
    xsimd::select(on, came_out + push - stays_out, came_out).store_unaligned(sums.came_out + lane);

    const Floats momentum =
        xsimd::select(on, load(block.mass + lane) * Floats(h.momentum_share), none);
    FloatVector impulse = momentum * change;
    add(sums.linear, lane, impulse);
    add(sums.angular, lane, cross(r, impulse));
    const Floats slid = (Floats(1.f) - share) * xsimd::sqrt(dot(along, along));
    const Floats lost = momentum * taken * xsimd::sqrt(square) * slid * Floats(2.f / h.h);
    (load(sums.friction + lane) + lost).store_unaligned(sums.friction + lane);

    FloatVector to = u + by;
    at.put(flight.u, block.place, lane, select(on, to, u));
    FloatVector before = at.get(flight.u_before, block.place, lane);
    FloatVector start = fused(push - stays_out, p.normal, before);
    at.put(flight.u_before, block.place, lane, select(on, start, before));
    if (flight.is_mended()) {
      to = select(on, fused(push - stays_out, p.normal, led_to), led_to);
      at.put(flight.led_to, block.place, lane, to);
    }
    at.put(flight.predicted, block.place, lane, select(on, to, predicted));
    at.put(flight.v, block.place, lane, select(on, v + change, v_before));
    touching |= bits(on) << lane;
    far |= bits(on && dot(by, by) > load(block.far + lane)) << lane;
  }
  h.touching[i] = static_cast<std::uint16_t>(touching);
  h.moved[i] = static_cast<std::uint16_t>(far);
  h.quick[i] = static_cast<std::uint16_t>(quick);
}

template <class At>
[[gnu::always_inline]] inline void solve_contacts_at(const BodySolve& h, std::size_t first,
                                                     std::size_t last, At at) {
  for (std::size_t i = first; i < last; ++i) {
    if (h.frames[h.pairs[i].body].kind == BodyKind::field)
      solve_field_pair(h, i);
    else
      solve_pair(h, i, at);
  }
}

void solve_body_contacts(const BodySolve& hold, std::size_t first, std::size_t last) {
  const BodySolve h = hold;
  if (h.woven)
    solve_contacts_at(h, first, last, InWovenRow{});
  else
    solve_contacts_at(h, first, last, InQuads{});
}

template <class At>
[[gnu::always_inline]] inline Floats depths_of_pair(const BodySolve& h, std::size_t i, At at) {
  const BodyBlock& block = h.blocks[h.pairs[i].block];
  const BodyFrame& f = h.frames[h.pairs[i].body];
  if (f.kind == BodyKind::field) return Floats(depth_of_field_pair(h, i));
  Floats deepest(0.f);
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    FloatVector u = at.get(h.flight.u, block.place, lane);
    const TouchLanes p = begin_touch(h, block, f, lane, at, u);
    const Floats spared = load(h.spared + i * kernels::kLanes + lane);
    const Floats depth = xsimd::select(p.near, Floats(0.f) - p.gap - spared, Floats(0.f));
    deepest = xsimd::max(deepest, depth);
  }
  return deepest;
}

float deepest_in_bodies(const BodySolve& hold, std::size_t first, std::size_t last) {
  const BodySolve h = hold;
  Floats deepest(0.f);
  for (std::size_t i = first; i < last; ++i) {
    const Floats depth =
        h.woven ? depths_of_pair(h, i, InWovenRow{}) : depths_of_pair(h, i, InQuads{});
    deepest = xsimd::max(deepest, depth);
  }
  float lanes[kFloats];
  deepest.store_unaligned(lanes);
  float most = 0;
  for (const float lane : lanes) most = lane > most ? lane : most;
  return most;
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
