/// Contacts in lanes: reference/contacts.h has the law, and the same in double.
#pragma once

#include "kernels/reference/contacts.h"
#include "kernels/simd/contact_data.h"
#include "kernels/simd/in_rows.h"
#include "kernels/simd/quads.h"
#include "kernels/simd/stars.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// Vectors and their fourths.
struct WeighedVector {
  FloatVector v;
  Floats w;
};
[[gnu::always_inline]] inline WeighedVector weighed(const float* quads, const std::uint32_t* slot) {
  const Floats q0 = load_quads(quads, QuadSlots{slot}), q1 = load_quads(quads, QuadSlots{slot + 1}),
               q2 = load_quads(quads, QuadSlots{slot + 2}),
               q3 = load_quads(quads, QuadSlots{slot + 3});
  const Floats xy01 = unpack_low(q0, q1), xy23 = unpack_low(q2, q3);
  const Floats zw01 = unpack_high(q0, q1), zw23 = unpack_high(q2, q3);
  return {{low_pairs(xy01, xy23), high_pairs(xy01, xy23), low_pairs(zw01, zw23)},
          high_pairs(zw01, zw23)};
}
[[gnu::always_inline]] inline void put_weighed(float* quads, const std::uint32_t* slot,
                                               const FloatVector& v, Floats w) {
  const Floats xy01 = unpack_low(v.x, v.y), xy23 = unpack_high(v.x, v.y);
  const Floats zw01 = unpack_low(v.z, w), zw23 = unpack_high(v.z, w);
  store_quads(quads, QuadSlots{slot}, low_pairs(xy01, zw01));
  store_quads(quads, QuadSlots{slot + 1}, high_pairs(xy01, zw01));
  store_quads(quads, QuadSlots{slot + 2}, low_pairs(xy23, zw23));
  store_quads(quads, QuadSlots{slot + 3}, high_pairs(xy23, zw23));
}

[[gnu::always_inline]] inline Floats from_0_to_1(Floats x) {
  return xsimd::min(xsimd::max(x, Floats(0.f)), Floats(1.f));
}
[[gnu::always_inline]] inline Floats least_square() { return Floats(1e-30f); }
[[gnu::always_inline]] inline Floats single(double x) { return Floats(static_cast<float>(x)); }

/// Where two features are nearest to each other.
struct NearestLanes {
  FloatVector r;  // from the second to the first
  Floats weight[4];
  FloatMask is_in_place;  // of edges: within both
};

/// The share of a segment u at which it is nearest to what is at r from its beginning.
[[gnu::always_inline]] inline Floats share_of(const FloatVector& u, const FloatVector& r) {
  return from_0_to_1(dot(u, r) / xsimd::max(dot(u, u), least_square()));
}

[[gnu::always_inline]] inline NearestLanes nearest_of_triangle(const FloatVector& p,
                                                               const FloatVector& a,
                                                               const FloatVector& b,
                                                               const FloatVector& c) {
  const Floats none(0.f), one(1.f);
  FloatVector u = b - a, v = c - a, w = p - a, e = c - b, f = p - b;
  const Floats uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v);
  const Floats area = fused_from(uv, uv, uu * vv);
  const Floats s = fused_from(uv, wv, vv * wu), t = fused_from(uv, wu, uu * wv);
  const FloatMask is_within =
      s > none && t > none && s + t < area && area > Floats(1e-6f) * uu * vv;
  const Floats per_area = one / xsimd::max(area, least_square());
  // The nearest side.
  const Floats on_u = share_of(u, w), on_v = share_of(v, w), on_e = share_of(e, f);
  FloatVector from_u = fused_from(on_u, u, w), from_v = fused_from(on_v, v, w),
              from_e = fused_from(on_e, e, f);
  const Floats of_u = dot(from_u, from_u), of_v = dot(from_v, from_v), of_e = dot(from_e, from_e);
  Floats at_b = on_u, at_c = none;
  const FloatMask v_nearer = of_v < of_u;
  at_b = xsimd::select(v_nearer, none, at_b);
  at_c = xsimd::select(v_nearer, on_v, at_c);
  const FloatMask e_nearer = of_e < xsimd::min(of_u, of_v);
  at_b = xsimd::select(e_nearer, one - on_e, at_b);
  at_c = xsimd::select(e_nearer, on_e, at_c);
  at_b = xsimd::select(is_within, s * per_area, at_b);
  at_c = xsimd::select(is_within, t * per_area, at_c);
  NearestLanes nearest;
  nearest.r = fused_from(at_c, v, fused_from(at_b, u, w));
  nearest.weight[0] = one;
  nearest.weight[1] = at_b + at_c - one;
  nearest.weight[2] = none - at_b;
  nearest.weight[3] = none - at_c;
  nearest.is_in_place = one > none;
  return nearest;
}

[[gnu::always_inline]] inline NearestLanes nearest_of_edges(const FloatVector& a,
                                                            const FloatVector& b,
                                                            const FloatVector& c,
                                                            const FloatVector& d, Floats least) {
  const Floats none(0.f), one(1.f);
  FloatVector u = b - a, v = d - c, w = a - c;
  const Floats uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
  const Floats determinant = fused_from(uv, uv, uu * vv);
  const FloatMask crosses = determinant > single(reference::kLeastCrossing) * uu * vv;
  const Floats per = one / xsimd::max(determinant, least_square());
  const Floats s = fused_from(uw, vv, uv * vw) * per, t = fused_from(uv, uw, uu * vw) * per;
  const Floats most = one - least;
  NearestLanes nearest;
  nearest.is_in_place = crosses && s > least && s < most && t > least && t < most;
  const Floats at_s = from_0_to_1(s), at_t = from_0_to_1(t);
  nearest.r = fused_from(at_t, v, fused(at_s, u, w));
  nearest.weight[0] = one - at_s;
  nearest.weight[1] = at_s;
  nearest.weight[2] = at_t - one;
  nearest.weight[3] = none - at_t;
  return nearest;
}

/// The unit vector from an edge into the face that has this third corner; 0 where there is none.
[[gnu::always_inline]] inline FloatVector into_face(const FloatVector& a, const FloatVector& b,
                                                    const FloatVector& third) {
  FloatVector u = b - a, v = third - a;
  const Floats at = dot(u, v) / xsimd::max(dot(u, u), least_square());
  FloatVector m = fused_from(at, u, v);
  const Floats square = dot(m, m);
  const Floats per =
      xsimd::select(square > Floats(1e-10f) * dot(v, v),
                    Floats(1.f) / xsimd::sqrt(xsimd::max(square, least_square())), Floats(0.f));
  return per * m;
}

/// Where two sides meet at 45 degrees a turn leaves half of what is in the plane of both.
constexpr int kTurnsAtCorner = 3;

/// Takes off r what leans over a face of its edge. towards: the sign of r that leads away from it.
[[gnu::always_inline]] inline FloatVector off_face(const FloatVector& r, const FloatVector& m,
                                                   bool is_first) {
  const Floats along = dot(r, m), none(0.f);
  return fused_from(is_first ? xsimd::min(along, none) : xsimd::max(along, none), m, r);
}

template <bool kEdges>
[[gnu::always_inline]] inline void freeze_block(const ContactFreeze& f, ContactBlock& block) {
  const Floats none(0.f), one(1.f);
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    // Lanes that are not used may say so by a negative thickness.
    if (bits(load(block.thickness + lane) >= none) == 0) continue;
    const auto place = [&](const std::uint32_t(&of)[kernels::kLanes])
        __attribute__((always_inline)) {
      return weighed(f.places, of + lane);
    };
    WeighedVector a = place(block.point[0]), b = place(block.point[1]), c = place(block.point[2]),
                  d = place(block.point[3]);
    NearestLanes nearest = kEdges
                               ? nearest_of_edges(a.v, b.v, c.v, d.v, load(block.towards[0] + lane))
                               : nearest_of_triangle(a.v, b.v, c.v, d.v);
    FloatVector r = nearest.r, before = load(block.normal, lane);
    const Floats distance = xsimd::sqrt(dot(r, r));
    const FloatMask has_side = distance > Floats(f.rounding);
    FloatVector off = r;
    if constexpr (kEdges) {
      off = off_face(off, into_face(a.v, b.v, place(block.beside[0]).v), true);
      off = off_face(off, into_face(a.v, b.v, place(block.beside[1]).v), true);
      off = off_face(off, into_face(c.v, d.v, place(block.beside[2]).v), false);
      off = off_face(off, into_face(c.v, d.v, place(block.beside[3]).v), false);
    } else {
      // Over the face across each side on which the nearest point lies. At a corner there are two,
      // and what one takes off leans over the other: by turns this comes to where both let it be.
      const auto over_side = [&](Floats opposite, const FloatVector& p, const FloatVector& q,
                                 std::size_t k) __attribute__((always_inline)) {
        FloatVector m = load(block.towards[k] + lane) * into_face(p, q, place(block.beside[k]).v);
        return select(opposite >= none - single(reference::kLeastWithin), m, no_vector());
      };
      FloatVector bc = over_side(nearest.weight[3], b.v, c.v, 0);
      FloatVector cd = over_side(nearest.weight[1], c.v, d.v, 1);
      FloatVector db = over_side(nearest.weight[2], d.v, b.v, 2);
      for (int turn = 0; turn < kTurnsAtCorner; ++turn)
        off = off_face(off_face(off_face(off, bc, false), cd, false), db, false);
    }
    const Floats left = xsimd::sqrt(dot(off, off));
    FloatMask stands = nearest.is_in_place && left > single(reference::kLeastLeft) * distance;
    FloatVector n = (one / xsimd::max(left, least_square())) * off;
    n = select(has_side, n, before);
    stands = stands && (has_side || dot(before, before) > none);
    const Floats w0 = nearest.weight[0], w1 = nearest.weight[1], w2 = nearest.weight[2],
                 w3 = nearest.weight[3];
    Floats sum = a.w * w0 * w0 + b.w * w1 * w1 + c.w * w2 * w2 + d.w * w3 * w3;
    const Floats largest = xsimd::max(xsimd::max(a.w, b.w), xsimd::max(c.w, d.w));
    sum = xsimd::max(sum, single(reference::kLeastGive) * largest);
    const Floats slack = single(reference::kSlack) * sum;
    stands = stands && sum > none;
    const Floats thickness = load(block.thickness + lane);
    // Features that are as far apart as the thickness are so along a normal that leans, too.
    const Floats over = xsimd::select(distance < thickness, dot(n, r), distance) - thickness;
    // The target is the thickness where it is farther apart, else what it has and what comes out.
    (xsimd::select(over < none, Floats(f.recovery) * over, over)).store_unaligned(block.gap + lane);
    slack.store_unaligned(block.slack + lane);
    xsimd::select(stands, one / xsimd::max(sum + slack, least_square()), none)
        .store_unaligned(block.give + lane);
    for (std::uint32_t k = 0; k < 4; ++k) nearest.weight[k].store_unaligned(block.weight[k] + lane);
    store(block.normal, lane, n);
    // Multipliers of the last substep, friction in the plane of now.
    const Floats warm = xsimd::select(stands, Floats(f.warm), none);
    const Floats last = warm * load(block.push + lane),
                 push = xsimd::min(last, warm * load(block.before + lane));
    push.store_unaligned(block.push + lane);
    last.store_unaligned(block.before + lane);
    const Floats of_hold =
        warm * xsimd::select(push < last, push / xsimd::max(last, least_square()), one);
    FloatVector hold = of_hold * load(block.hold, lane);
    hold = fused_from(dot(hold, n), n, hold);
    store(block.hold, lane, hold);
  }
}

void freeze_contacts(const ContactFreeze& freeze, bool edges, std::size_t first, std::size_t last) {
  const ContactFreeze f = freeze;
  for (std::size_t i = first; i < last; ++i)
    edges ? freeze_block<true>(f, f.blocks[i]) : freeze_block<false>(f, f.blocks[i]);
}

/// Moves the points by their shares of what acts along `by` (kg m).
[[gnu::always_inline]] inline void move_points(float* moves, const ContactBlock& block,
                                               std::uint32_t lane, const FloatVector& by) {
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t* point = block.point[k] + lane;
    WeighedVector at = weighed(moves, point);
    FloatVector to = fused(at.w * load(block.weight[k] + lane), by, at.v);
    put_weighed(moves, point, to, at.w);
  }
}

void start_contacts(const ContactSolve& solve, const std::uint32_t* blocks, std::size_t count) {
  const ContactSolve s = solve;
  for (std::size_t i = 0; i < count; ++i) {
    const ContactBlock& block = s.blocks[blocks[i]];
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      const Floats push = load(block.push + lane);
      if (bits(push > Floats(0.f)) == 0) continue;
      FloatVector n = load(block.normal, lane), hold = load(block.hold, lane);
      move_points(s.moves, block, lane, fused(push, n, hold));
    }
  }
}

void visit_contacts(const ContactSolve& solve, const std::uint32_t* blocks, std::size_t count) {
  const ContactSolve s = solve;
  const Floats none(0.f), one(1.f);
  for (std::size_t i = 0; i < count; ++i) {
    ContactBlock& block = s.blocks[blocks[i]];
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      WeighedVector at[4];
      for (std::uint32_t k = 0; k < 4; ++k) at[k] = weighed(s.moves, block.point[k] + lane);
      Floats weight[4];
      for (std::uint32_t k = 0; k < 4; ++k) weight[k] = load(block.weight[k] + lane);
      FloatVector way = weight[0] * at[0].v;
      for (std::uint32_t k = 1; k < 4; ++k) way = fused(weight[k], at[k].v, way);
      FloatVector n = load(block.normal, lane), hold = load(block.hold, lane);
      const Floats along = dot(n, way), push = load(block.push + lane),
                   give = load(block.give + lane);
      const Floats error = fused(load(block.slack + lane), push, load(block.gap + lane) + along);
      const Floats more = xsimd::max(none - error * give, none - push), pushes = push + more;
      FloatVector slip = fused_from(along, n, way);
      FloatVector held = fused_from(give, slip, hold);
      const Floats length = xsimd::sqrt(dot(held, held)),
                   most = load(block.friction + lane) * pushes;
      const Floats kept =
          xsimd::select(length > most, most / xsimd::max(length, least_square()), one);
      held = kept * held;
      FloatVector by = fused(more, n, held - hold);
      if (bits(by.x != none || by.y != none || by.z != none) == 0) continue;
      pushes.store_unaligned(block.push + lane);
      store(block.hold, lane, held);
      for (std::uint32_t k = 4; k-- > 0;) {  // a point that is there twice has a weight once
        FloatVector to = fused(at[k].w * weight[k], by, at[k].v);
        put_weighed(s.moves, block.point[k] + lane, to, at[k].w);
      }
    }
  }
}

void find_active_contacts(const ContactSolve& solve, bool pushing, std::uint16_t* active,
                          std::size_t first, std::size_t last) {
  const ContactSolve s = solve;
  const Floats none(0.f);
  for (std::size_t i = first; i < last; ++i) {
    const ContactBlock& block = s.blocks[i];
    std::uint32_t found = 0;
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      const FloatMask counts = load(block.give + lane) > none;
      const FloatMask pushes = counts && load(block.push + lane) > none;
      if (pushing || bits(counts) == 0) {
        found |= bits(pushes) << lane;
        continue;
      }
      FloatVector way = load(block.weight[0] + lane) * weighed(s.moves, block.point[0] + lane).v;
      for (std::uint32_t k = 1; k < 4; ++k)
        way = fused(load(block.weight[k] + lane), weighed(s.moves, block.point[k] + lane).v, way);
      const Floats over = load(block.gap + lane) + dot(load(block.normal, lane), way);
      found |= bits(pushes || (counts && over < none)) << lane;
    }
    active[i] = static_cast<std::uint16_t>(found);
  }
}

constexpr ContactKernels contact_kernels() {
  return {.freeze = freeze_contacts,
          .start = start_contacts,
          .visit = visit_contacts,
          .find_active = find_active_contacts,
          .turn_triangles = turn_triangles,
          .find_folded_stars = find_folded_stars};
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
