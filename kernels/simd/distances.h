/// Pairs of features in lanes: reference::nearest_in_triangle and nearest_of_edges
/// (kernels/reference/distances.h), and what is asked of many pairs at a time. Points stand in
/// quads (quads.h), from an origin that is near to them.
#pragma once

#include "kernels/simd/in_rows.h"
#include "kernels/simd/quads.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

struct PairCorners {
  FloatVector a, b, c, d;
};
[[gnu::always_inline]] inline PairCorners corners_of(const float* quads, const PairBlock& pairs,
                                                     std::uint32_t lane) {
  const QuadLanes at;
  return {at.get(quads, pairs.point[0] + lane), at.get(quads, pairs.point[1] + lane),
          at.get(quads, pairs.point[2] + lane), at.get(quads, pairs.point[3] + lane)};
}

[[gnu::always_inline]] inline Floats within(Floats x) {
  return xsimd::min(xsimd::max(x, Floats(0.f)), Floats(1.f));
}

/// From the nearest point of the segment that begins at p, seen from the origin, to the origin.
[[gnu::always_inline]] inline FloatVector from_segment(const FloatVector& p, const FloatVector& u) {
  const Floats at = within((Floats(0.f) - dot(p, u)) / xsimd::max(dot(u, u), tiny()));
  return {Floats(0.f) - fused(at, u.x, p.x), Floats(0.f) - fused(at, u.y, p.y),
          Floats(0.f) - fused(at, u.z, p.z)};
}

/// From the nearest point of a triangle to a point. It lies in the plane, or on a side.
struct FromTriangle {
  [[gnu::always_inline]] FloatVector operator()(const PairCorners& p) const {
    FloatVector b = p.b - p.a, u = p.c - p.b, v = p.d - p.b, w = p.d - p.c, c = p.c - p.a;
    FloatVector r = from_segment(b, u);
    Floats least = dot(r, r);
    for (int side = 0; side < 2; ++side) {
      FloatVector other = side == 0 ? from_segment(b, v) : from_segment(c, w);
      const Floats square = dot(other, other);
      r = select(square < least, other, r);
      least = xsimd::min(square, least);
    }
    const Floats uu = dot(u, u), uv = dot(u, v), vv = dot(v, v);
    const Floats bu = Floats(0.f) - dot(b, u), bv = Floats(0.f) - dot(b, v);
    const Floats area = fused_from(uv, uv, uu * vv);
    const Floats s = fused_from(uv, bv, vv * bu), t = fused_from(uv, bu, uu * bv);
    const Floats none(0.f);
    const FloatMask has_area = area > Floats(1e-6f) * uu * vv;
    const Floats per_area = Floats(1.f) / area;
    FloatVector in_plane = fused(s * per_area, u, fused(t * per_area, v, b));
    const FloatMask is_inside =
        has_area && s > none && t > none && s + t < area && dot(in_plane, in_plane) < least;
    return select(is_inside, no_vector() - in_plane, r);
  }
};

/// From the nearest point of the edge c d to that of the edge a b: within both, or at an end.
struct FromEdge {
  [[gnu::always_inline]] FloatVector operator()(const PairCorners& p) const {
    FloatVector u = p.b - p.a, v = p.d - p.c, w = p.a - p.c;
    FloatVector r = from_segment(p.c - p.a, v);
    Floats least = dot(r, r);
    const auto consider = [&](const FloatVector& other, const FloatMask& counts) {
      const Floats square = dot(other, other);
      const FloatMask nearer = counts && square < least;
      r = select(nearer, other, r);
      least = xsimd::select(nearer, square, least);
    };
    const FloatMask always = Floats(0.f) == Floats(0.f);
    consider(from_segment(p.c - p.b, v), always);
    consider(no_vector() - from_segment(w, u), always);
    consider(no_vector() - from_segment(p.a - p.d, u), always);
    const Floats uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
    const Floats none(0.f), determinant = fused_from(uv, uv, uu * vv);
    const Floats s = fused_from(uw, vv, uv * vw), t = fused_from(uv, uw, uu * vw);
    const FloatMask is_within = determinant > Floats(1e-6f) * uu * vv && s > none &&
                                s < determinant && t > none && t < determinant;
    const Floats part = Floats(1.f) / determinant;
    consider(fused_from(t * part, v, fused(s * part, u, w)), is_within);
    return r;
  }
};

/// Whether the lines of two edges are nearest to each other at most `beyond` of their lengths past
/// their ends, or nearly parallel. Others are near to each other at a corner, as pairs with that.
[[gnu::always_inline]] inline FloatMask may_face(const PairCorners& p, float beyond) {
  FloatVector u = p.b - p.a, v = p.d - p.c, r = p.a - p.c;
  const Floats uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), ur = dot(u, r), vr = dot(v, r);
  const Floats determinant = fused_from(uv, uv, uu * vv), spare = Floats(beyond) * determinant;
  const Floats s = fused_from(ur, vv, uv * vr), t = fused_from(uv, ur, uu * vr);
  const Floats least = Floats(0.f) - spare, most = determinant + spare;
  const FloatMask is_parallel = determinant <= Floats(0.01f) * uu * vv;
  return is_parallel || (s > least && s < most && t > least && t < most);
}

/// The distance that points of the two features may come off their ways, at most and together.
[[gnu::always_inline]] inline Floats largest_fourths(const float* quads, const PairBlock& pairs,
                                                     bool edges, std::uint32_t lane) {
  const QuadLanes at;
  const Floats a = at.fourth(quads, pairs.point[0] + lane),
               b = at.fourth(quads, pairs.point[1] + lane),
               c = at.fourth(quads, pairs.point[2] + lane),
               d = at.fourth(quads, pairs.point[3] + lane);
  const Floats last = xsimd::max(c, d);
  return edges ? xsimd::max(a, b) + last : a + xsimd::max(b, last);
}

template <class From>
[[gnu::always_inline]] inline void measure_block(const PairMeasure& m, std::size_t i, From from,
                                                 bool edges) {
  const Floats none(0.f);
  std::uint32_t near = 0;
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    FloatVector r = from(corners_of(m.points, m.pairs[i], lane));
    const Floats distance = xsimd::sqrt(dot(r, r));
    FloatVector n = (Floats(1.f) / xsimd::max(distance, tiny())) * r;
    const PairCorners way = corners_of(m.ways, m.pairs[i], lane);
    const Floats a = dot(n, way.a), b = dot(n, way.b), c = dot(n, way.c), d = dot(n, way.d);
    const Floats first = edges ? xsimd::min(a, b) : a;
    const Floats second = edges ? xsimd::max(c, d) : xsimd::max(b, xsimd::max(c, d));
    const Floats closing = xsimd::max(none, second - first);
    distance.store_unaligned(m.distance[i] + lane);
    FloatMask is_near =
        distance - closing < Floats(m.reach) + largest_fourths(m.ways, m.pairs[i], edges, lane);
    if (edges) is_near = is_near && may_face(corners_of(m.points, m.pairs[i], lane), m.beyond);
    near |= bits(is_near) << lane;
  }
  m.near[i] = static_cast<std::uint16_t>(near);
}

void measure_pairs(const PairMeasure& measure, bool edges, std::size_t first, std::size_t last) {
  const PairMeasure m = measure;
  for (std::size_t i = first; i < last; ++i) {
    if (edges)
      measure_block(m, i, FromEdge{}, true);
    else
      measure_block(m, i, FromTriangle{}, false);
  }
}

/// A place past its ends by so much of the length of an edge is so by floats, too.
constexpr float kSurelyPast = 1e-3f;

/// Edges that are nearest to each other at an end of one do not touch: their corners do.
template <class From>
[[gnu::always_inline]] inline void touch_block(const PairTouch& t, std::size_t i, From from,
                                               bool edges) {
  std::uint32_t touching = 0;
  PairSide& side = t.sides[i];
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    const PairCorners corners = corners_of(t.points, t.pairs[i], lane);
    FloatVector r = from(corners);
    const Floats distance = xsimd::sqrt(dot(r, r));
    FloatVector before = load(side.normal, lane);
    const FloatMask stays = dot(r, before) > Floats(0.f) && distance > Floats(t.rounding);
    FloatVector n = (Floats(1.f) / xsimd::max(distance, tiny())) * r;
    store(side.normal, lane, select(stays, n, before));
    FloatMask is_near = distance < load(side.thickness + lane) + Floats(t.rounding);
    if (edges) is_near = is_near && may_face(corners, kSurelyPast);
    touching |= bits(!stays || is_near) << lane;
  }
  t.touching[i] = static_cast<std::uint16_t>((touching | side.used >> kernels::kLanes) & side.used);
}

void touch_pairs(const PairTouch& touch, bool edges, std::size_t first, std::size_t last) {
  const PairTouch t = touch;
  for (std::size_t i = first; i < last; ++i) {
    if (edges)
      touch_block(t, i, FromEdge{}, true);
    else
      touch_block(t, i, FromTriangle{}, false);
  }
}

/// The largest square of what a corner of the first feature moves beside one of the second.
[[gnu::always_inline]] inline Floats largest_move_of(const PairCorners& by, bool edges) {
  const auto square = [](const FloatVector& v, const FloatVector& w) {
    FloatVector d = v - w;
    return dot(d, d);
  };
  const Floats of_a = xsimd::max(square(by.a, by.c), square(by.a, by.d));
  return xsimd::max(
      of_a, edges ? xsimd::max(square(by.b, by.c), square(by.b, by.d)) : square(by.a, by.b));
}

void find_moved_pairs(const PairMoves& moves, bool edges, std::size_t first, std::size_t last) {
  const PairMoves m = moves;
  for (std::size_t i = first; i < last; ++i) {
    std::uint32_t moved = 0;
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      const Floats least = load(m.distance[i] + lane) * Floats(kSurelyApart) - Floats(m.rounding);
      if (bits(least <= Floats(m.most)) == 0) continue;
      const PairCorners by = corners_of(m.moves, m.pairs[i], lane);
      const Floats most = largest_move_of(by, edges);
      moved |= bits(least <= Floats(0.f) || most >= least * least) << lane;
    }
    m.moved[i] = static_cast<std::uint16_t>(moved);
  }
}

/// Per block, a bit per lane: which of `of` are at most `limit`.
void find_small(const float (*of)[kernels::kLanes], float limit, std::uint16_t* small,
                std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    std::uint32_t found = 0;
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats)
      found |= bits(load(of[i] + lane) <= Floats(limit)) << lane;
    small[i] = static_cast<std::uint16_t>(found);
  }
}

/// Which of the boxes of a cluster the box from `low` to `high` meets.
std::uint32_t find_met(const BoxCluster& cluster, const float* low, const float* high) {
  std::uint32_t met = 0;
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    FloatMask meets = Floats(0.f) == Floats(0.f);
    for (std::uint32_t k = 0; k < 3; ++k) {
      meets = meets && load(cluster.low[k] + lane) <= Floats(high[k]) &&
              load(cluster.high[k] + lane) >= Floats(low[k]);
    }
    met |= bits(meets) << lane;
  }
  return met;
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
