/// Pairs that touch pushed apart in lanes: reference::stop and slow (kernels/reference/bodies.h),
/// which have the formulas, at two features whose points count by their weights. Pairs of a block
/// move no point in common, so they are as if they came one after the other.
#pragma once

#include "kernels/reference/bodies.h"
#include "kernels/simd/bodies.h"
#include "kernels/simd/distances.h"
#include "kernels/simd/touch_data.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

[[gnu::always_inline]] inline FloatMask mask_of(std::uint32_t lanes) {
  alignas(64) static constexpr std::int32_t kLaneBits[16] = {
      1 << 0, 1 << 1, 1 << 2,  1 << 3,  1 << 4,  1 << 5,  1 << 6,  1 << 7,
      1 << 8, 1 << 9, 1 << 10, 1 << 11, 1 << 12, 1 << 13, 1 << 14, 1 << 15};
  const Ints set = Ints(static_cast<std::int32_t>(lanes)) & Ints::load_aligned(kLaneBits);
  return xsimd::to_float(set) > Floats(0.f);
}

/// A vector and what stands beside it in its quad.
struct WholeQuads {
  FloatVector v;
  Floats w;
};
[[gnu::always_inline]] inline WholeQuads get_whole(const float* u, const std::uint32_t* slot) {
  const Floats q0 = load_quads(u, QuadSlots{slot}), q1 = load_quads(u, QuadSlots{slot + 1}),
               q2 = load_quads(u, QuadSlots{slot + 2}), q3 = load_quads(u, QuadSlots{slot + 3});
  const Floats xy01 = unpack_low(q0, q1), xy23 = unpack_low(q2, q3);
  const Floats zw01 = unpack_high(q0, q1), zw23 = unpack_high(q2, q3);
  return {{low_pairs(xy01, xy23), high_pairs(xy01, xy23), low_pairs(zw01, zw23)},
          high_pairs(zw01, zw23)};
}
[[gnu::always_inline]] inline void put_whole(float* u, const std::uint32_t* slot,
                                             const FloatVector& v, Floats w) {
  const Floats xy01 = unpack_low(v.x, v.y), xy23 = unpack_high(v.x, v.y);
  const Floats zw01 = unpack_low(v.z, w), zw23 = unpack_high(v.z, w);
  store_quads(u, QuadSlots{slot}, low_pairs(xy01, zw01));
  store_quads(u, QuadSlots{slot + 1}, high_pairs(xy01, zw01));
  store_quads(u, QuadSlots{slot + 2}, low_pairs(xy23, zw23));
  store_quads(u, QuadSlots{slot + 3}, high_pairs(xy23, zw23));
}

/// The four points of kFloats pairs, seen from the first.
struct TouchLanes {
  WholeQuads place[4];
  FloatVector x[4];
  Floats weight[4];  // with their signs
  FloatVector n;     // from the second feature to the first
  Floats gap;

  [[gnu::always_inline]] TouchLanes(const PairPush& p, std::size_t block, std::uint32_t lane) {
    for (int k = 0; k < 4; ++k)
      place[k] = get_whole(p.points.places, p.pairs[block].point[k] + lane);
    for (int k = 0; k < 4; ++k)
      x[k] = between_places(place[0].v, place[k].v, Floats(p.points.unit));
  }
  /// Whether a point beside the features stands out along n, seen from `from`.
  [[gnu::always_inline]] FloatMask stands_out(const PairPush& p, const std::uint32_t* point,
                                              const FloatVector& from, const FloatVector& along) {
    const QuadLanes at;
    FloatVector d =
        between_places(place[0].v, at.get(p.points.places, point), Floats(p.points.unit)) - from;
    const Floats l = xsimd::sqrt(dot(d, d));
    return dot(along, d) > Floats(p.lean) * l;
  }
};

/// Of edges whether one beside them is nearer; of a triangle's side likewise.
struct Beside {
  FloatMask ghost, undecided;
};
[[gnu::always_inline]] inline Beside look_beside_edges(const PairPush& p, TouchLanes& t,
                                                       const TouchBlock& touch,
                                                       std::uint32_t lane) {
  FloatVector on_first = t.weight[1] * t.x[1];
  FloatVector on_second = fused(Floats(0.f) - t.weight[3], t.x[3] - t.x[2], t.x[2]);
  FloatVector back = no_vector() - t.n;
  FloatMask ghost = t.stands_out(p, touch.beside[0] + lane, on_second, t.n) ||
                    t.stands_out(p, touch.beside[1] + lane, on_second, t.n) ||
                    t.stands_out(p, touch.beside[2] + lane, on_first, back) ||
                    t.stands_out(p, touch.beside[3] + lane, on_first, back);
  return {ghost, Floats(0.f) > Floats(0.f)};
}
[[gnu::always_inline]] inline Beside look_beside_triangle(const PairPush& p, TouchLanes& t,
                                                          const TouchBlock& touch,
                                                          std::uint32_t lane, FloatMask touches) {
  const Floats none(0.f);
  Beside beside{none > none, none > none};
  const FloatMask on[3] = {t.weight[3] == none && touches, t.weight[1] == none && touches,
                           t.weight[2] == none && touches};
  if (bits(on[0] || on[1] || on[2]) == 0) return beside;
  for (int k = 0; k < 3; ++k) {
    const FloatMask at_corner = on[k] && on[(k + 1) % 3];
    beside.undecided = beside.undecided || at_corner;
    if (bits(on[k]) == 0) continue;
    beside.ghost =
        beside.ghost || (on[k] && t.stands_out(p, touch.beside[k] + lane, t.x[1 + k], t.n));
  }
  return beside;
}

/// What a touch makes of the points, as reference::Stop and reference::Slowed.
struct PushLanes {
  FloatMask pushes;
  Floats comes_out, slid, taken;
  FloatVector by, change;
};
[[gnu::always_inline]] inline PushLanes push_of(const PairPush& p, const TouchLanes& t,
                                                const FloatVector& slip,
                                                const FloatVector& relative, TouchBlock& touch,
                                                std::uint32_t lane, FloatMask touches) {
  const Floats none(0.f), friction = load(touch.friction + lane);
  const auto keep = [&](float* to, Floats value, FloatMask where) {
    xsimd::select(where, value, load(to + lane)).store_unaligned(to + lane);
  };
  PushLanes push;
  FloatVector n = t.n;
  const Floats approach = none - dot(n, slip);
  const Floats came_out = load(touch.came_out + lane), began = t.gap + approach - came_out;
  constexpr auto kSlow = static_cast<float>(reference::kRecovery),
                 kFast = static_cast<float>(reference::kFastestRecovery),
                 kTime = static_cast<float>(1 / reference::kRecoveryTime);
  const Floats recovers =
      Floats(p.h) * xsimd::min(Floats(kFast), Floats(kSlow) - Floats(kTime) * began);
  const Floats target = xsimd::select(began < none, xsimd::min(none, began + recovers), none);
  const Floats along_n = target - t.gap;
  push.pushes = touches && along_n > none;
  const Floats stays_out = xsimd::min(along_n, xsimd::max(none, approach));
  push.comes_out = along_n - stays_out;
  const Floats pushed = load(touch.pushed + lane) + stays_out;
  keep(touch.pushed, pushed, push.pushes);
  keep(touch.came_out, came_out + push.comes_out, push.pushes);
  FloatVector along = fused(approach, n, slip);
  const Floats l = xsimd::sqrt(dot(along, along));
  Floats held = load(touch.held + lane);
  const Floats share = held_share(l, friction * pushed, held);
  keep(touch.held, held, push.pushes);
  push.slid = (Floats(1.f) - share) * l;
  push.by = fused_from(share, along, along_n * n);

  const Floats speed = dot(n, relative), into = xsimd::max(none, none - speed);
  const Floats stopped = load(touch.stopped + lane) + into;
  keep(touch.stopped, stopped, push.pushes);
  FloatVector sliding = fused_from(speed, n, relative);
  const Floats slides = xsimd::sqrt(dot(sliding, sliding));
  Floats slowed = load(touch.slowed + lane);
  const Floats slow_share = held_share(slides, friction * stopped, slowed);
  keep(touch.slowed, slowed, push.pushes);
  push.taken = slow_share * slides;
  push.change = fused_from(slow_share, sliding, into * n);
  return push;
}

/// Adds what the pair takes from the body.
[[gnu::always_inline]] inline void load_body(const PairPush& p, const TouchLanes& t,
                                             const PushLanes& push, const FloatVector* speeds,
                                             Floats momentum, TouchBlock& touch,
                                             std::uint32_t lane) {
  const Floats none(0.f);
  FloatVector velocity = no_vector(), arm = no_vector(), first = no_vector();
  for (int k = 3; k >= 0; --k) {
    if ((p.of_body >> k & 1) != 0) first = t.x[k];
  }
  for (int k = 0; k < 4; ++k) {
    if ((p.of_body >> k & 1) == 0) continue;
    const Floats weight = xsimd::abs(t.weight[k]);
    velocity = fused(weight, speeds[k], velocity);
    arm = fused(weight, t.x[k] - first, arm);
  }
  FloatVector impulse = xsimd::select(push.pushes, momentum, none) * push.change;
  FloatVector moment = cross_of(arm, impulse);
  FloatVector before = load(touch.impulse, lane), turned = load(touch.moment, lane),
              fast = load(touch.velocity, lane);
  store(touch.impulse, lane, before + impulse);
  store(touch.moment, lane, turned + moment);
  store(touch.velocity, lane, select(push.pushes, velocity, fast));
  (load(touch.work + lane) + dot(impulse, velocity)).store_unaligned(touch.work + lane);
  const Floats taken =
      xsimd::select(push.pushes, xsimd::abs(momentum) * push.taken * push.slid, none);
  fused(taken, Floats(1.f / p.h), load(touch.friction_work + lane))
      .store_unaligned(touch.friction_work + lane);
}

template <class From>
[[gnu::always_inline]] inline PushedPairs push_lanes(const PairPush& p, std::size_t block,
                                                     std::uint32_t lane, std::uint32_t active,
                                                     From from, bool edges) {
  const Floats none(0.f);
  const std::uint32_t* point[4];
  for (int k = 0; k < 4; ++k) point[k] = p.pairs[block].point[k] + lane;
  TouchLanes t(p, block, lane);
  const NearestLanes nearest = from(PairCorners{t.x[0], t.x[1], t.x[2], t.x[3]});
  PairSide& side = p.sides[block];
  TouchBlock& touch = p.touches[block];
  FloatVector r = nearest.r, before = load(side.normal, lane);
  const Floats distance = xsimd::sqrt(dot(r, r));
  t.n = (Floats(1.f) / xsimd::max(distance, tiny())) * r;
  t.gap = distance - load(side.thickness + lane);
  const FloatMask acts = mask_of(active);
  const FloatMask known = dot(r, before) > none && distance > Floats(p.surely_apart) &&
                          !mask_of(side.used >> kernels::kLanes >> lane);
  store(side.normal, lane, select(acts && known, t.n, before));
  FloatMask touches = acts && known && t.gap < none;
  if (edges)
    touches =
        touches && nearest.a > none && nearest.b > none && nearest.c > none && nearest.d > none;
  PushedPairs found{.undecided = bits(acts && !known)};
  if (bits(touches) == 0) return found;
  t.weight[0] = nearest.a;
  t.weight[1] = edges ? nearest.b : none - nearest.b;
  t.weight[2] = none - nearest.c;
  t.weight[3] = none - nearest.d;
  const Beside beside = edges ? look_beside_edges(p, t, touch, lane)
                              : look_beside_triangle(p, t, touch, lane, touches);
  found.undecided |= bits(beside.undecided);
  touches = touches && !beside.ghost && !beside.undecided;
  if (bits(touches) == 0) return found;

  const QuadLanes at;
  FloatVector moves[4], speeds[4], slip = no_vector(), relative = no_vector();
  Floats sum = none, largest = none, moved = none;
  for (int k = 0; k < 4; ++k) {
    moves[k] = at.get(p.points.moves, point[k]);
    speeds[k] = at.get(p.points.speeds, point[k]);
    slip = fused(t.weight[k], moves[k], slip);
    relative = fused(t.weight[k], speeds[k], relative);
    const Floats w = t.place[k].w;
    sum = fused(w * t.weight[k], t.weight[k], sum);
    largest = xsimd::max(largest, w);
    moved = moved + xsimd::select(w > none, t.weight[k], none);
  }
  touches = touches && sum > none;
  const Floats per_sum =
      Floats(1.f) / xsimd::max(sum, xsimd::max(Floats(p.least_weight) * largest, tiny()));
  const PushLanes push = push_of(p, t, slip, relative, touch, lane, touches);
  found.pushed = bits(push.pushes);
  if (found.pushed == 0) return found;
  if (p.of_body != 0)
    load_body(p, t, push, speeds, Floats(p.momentum_share) * moved * per_sum, touch, lane);
  const Floats per_unit(1.f / p.points.unit);
  const bool comes_out = bits(push.pushes && push.comes_out > none) != 0;
  for (int k = 0; k < 4; ++k) {
    const Floats w = t.place[k].w;
    if (bits(w > none) == 0) continue;
    const Floats part = xsimd::select(push.pushes, w * t.weight[k] * per_sum, none);
    FloatVector by = part * push.by;
    const auto moved_to = [&](Floats from_place, Floats way) {
      return same_bits<Floats>(same_bits<Ints>(from_place) +
                               xsimd::nearbyint_as_int(way * per_unit));
    };
    const FloatVector& v = t.place[k].v;
    put_whole(p.points.places, point[k],
              {moved_to(v.x, by.x), moved_to(v.y, by.y), moved_to(v.z, by.z)}, w);
    FloatVector out = (part * push.comes_out) * t.n;
    at.put(p.points.moves, point[k], moves[k] + by - out);
    at.put(p.points.speeds, point[k], fused(part, push.change, speeds[k]));
    if (!comes_out) continue;
    FloatVector came = at.get(p.points.came_out, point[k]);
    at.put(p.points.came_out, point[k], came + out);
  }
  return found;
}

/// Of pairs of a block that are active.
PushedPairs push_pairs(const PairPush& push, bool edges, std::size_t block, std::uint32_t active) {
  PushedPairs all;
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    const std::uint32_t here = active >> lane & ((1u << kFloats) - 1);
    if (here == 0) continue;
    const PushedPairs found = edges ? push_lanes(push, block, lane, here, FromEdge{}, true)
                                    : push_lanes(push, block, lane, here, FromTriangle{}, false);
    all.pushed |= found.pushed << lane;
    all.undecided |= found.undecided << lane;
  }
  return all;
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
