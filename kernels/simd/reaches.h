/// Which features of two triangles may meet in a step: those of which no direction is known that
/// keeps their tubes apart where these begin and where they end. Lanes are directions.
#pragma once

#include <bit>

#include "kernels/simd/lanes.h"
#include "kernels/simd/nearness_data.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

constexpr std::uint32_t kHalfOfReach = kReachLanes / 2;

/// x at lanes where tubes begin, y where they end; kFloats lanes from `lane` on.
[[gnu::always_inline]] inline Floats both(float x, float y, std::uint32_t lane) {
  if constexpr (kFloats > kHalfOfReach) {
    alignas(64) static constexpr float kEnds[16] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1};
    return xsimd::select(load(kEnds) > Floats(0.f), Floats(y), Floats(x));
  }
  return Floats(lane < kHalfOfReach ? x : y);
}
/// The quads of a tube stand in the lanes 0 to 3 where it begins, and in 8 to 11 where it ends.
struct EndQuads {
  std::uint32_t lane;
  [[gnu::always_inline]] std::size_t operator[](std::uint32_t k) const {
    return 4 * ((lane + k) / kHalfOfReach);
  }
};
[[gnu::always_inline]] inline FloatMask are_first(std::uint32_t lane) {
  alignas(64) static constexpr float kFirst[16] = {1, 1, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0};
  return load(kFirst + lane) > Floats(0.f);
}

[[gnu::always_inline]] inline void reach_of(const ReachAxes& axes, const PointTube& tube,
                                            FeatureReach& reach) {
  for (std::uint32_t lane = 0; lane < kReachLanes; lane += kFloats) {
    const auto at = [&](const float(&of)[2][4], std::uint32_t k) {
      return both(of[0][k], of[1][k], lane);
    };
    const Floats x = load(axes.x + lane), y = load(axes.y + lane), z = load(axes.z + lane);
    const Floats middle = x * at(tube.middle, 0) + y * at(tube.middle, 1) + z * at(tube.middle, 2);
    const Floats half = xsimd::abs(x) * at(tube.half, 0) + xsimd::abs(y) * at(tube.half, 1) +
                        xsimd::abs(z) * at(tube.half, 2);
    const Floats wide = half + Floats(0x1p-20f) * at(tube.middle, 3);
    const FloatMask are_given = are_first(lane);
    select(are_given, load_quads(tube.low[0], EndQuads{lane}), middle - wide)
        .store_unaligned(reach.low + lane);
    select(are_given, load_quads(tube.high[0], EndQuads{lane}), middle + wide)
        .store_unaligned(reach.high + lane);
  }
}

[[gnu::always_inline]] inline void join(const FeatureReach& a, const FeatureReach& b,
                                        FeatureReach& all) {
  for (std::uint32_t lane = 0; lane < kReachLanes; lane += kFloats) {
    xsimd::min(load(a.low + lane), load(b.low + lane)).store_unaligned(all.low + lane);
    xsimd::max(load(a.high + lane), load(b.high + lane)).store_unaligned(all.high + lane);
  }
}

/// A feature on one side of the other at both ends is there all of the way.
[[gnu::always_inline]] inline bool meet(const FeatureReach& a, const FeatureReach& b) {
  std::uint32_t beyond = 0, before = 0;
  for (std::uint32_t lane = 0; lane < kReachLanes; lane += kFloats) {
    beyond |= bits(load(a.low + lane) > load(b.high + lane)) << lane;
    before |= bits(load(a.high + lane) < load(b.low + lane)) << lane;
  }
  return (((beyond & beyond >> kHalfOfReach) | (before & before >> kHalfOfReach)) & 0xff) == 0;
}

[[gnu::always_inline]] inline void write_reaches(const ReachAxes& axes, const PointTube& a,
                                                 const PointTube& b, const PointTube& c,
                                                 FeatureReach (&corner)[3], FeatureReach& whole) {
  reach_of(axes, a, corner[0]);
  reach_of(axes, b, corner[1]);
  reach_of(axes, c, corner[2]);
  join(corner[0], corner[1], whole);
  join(whole, corner[2], whole);
}

void reaches_of_triangle(const ReachAxes& axes, const PointTube* const* tubes,
                         TriangleReaches& to) {
  write_reaches(axes, *tubes[0], *tubes[1], *tubes[2], to.corner, to.whole);
  for (std::uint32_t k = 0; k < 3; ++k) join(to.corner[k], to.corner[(k + 1) % 3], to.edge[k]);
}

/// A bit of TriangleMeeting for two triangles that meet. corner: of the other one, and `whole`.
[[gnu::always_inline]] inline bool meet_at(std::uint32_t bit, const TriangleReaches& its,
                                           const FeatureReach (&corner)[3],
                                           const FeatureReach& whole) {
  if (bit < 4) return meet(its.corner[bit - 1], whole);
  if (bit < 7) return meet(corner[bit - 4], its.whole);
  const std::uint32_t j = (bit - 7) / 3;
  FeatureReach edge;
  join(corner[j], corner[(j + 1) % 3], edge);
  return meet(its.edge[bit - 7 - 3 * j], edge);
}

void meet_triangles(const TriangleMeeting& meeting, std::size_t count) {
  const TriangleReaches& its = *meeting.reaches;
  for (std::size_t i = 0; i < count; ++i) {
    FeatureReach corner[3], whole;
    const auto tube = [&](std::size_t k) -> const PointTube& {
      return meeting.tubes[meeting.corners[i][k]];
    };
    write_reaches(*meeting.axes, tube(0), tube(1), tube(2), corner, whole);
    std::uint32_t met = meet(its.whole, whole) ? 1 : 0;
    for (std::uint32_t left = met != 0 ? meeting.wanted[i] & ~1u : 0; left != 0; left &= left - 1) {
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(left));
      met |= (meet_at(bit, its, corner, whole) ? 1u : 0u) << bit;
    }
    meeting.met[i] = static_cast<std::uint16_t>(met);
  }
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
