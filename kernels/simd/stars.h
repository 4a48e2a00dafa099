/// Which stars of a cloth fold: not all of their triangles face one direction all of the time.
#pragma once

#include <algorithm>

#include "kernels/simd/quads.h"
#include "kernels/simd/star_data.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

[[gnu::always_inline]] inline Floats size_of(const FloatVector& v) {
  return xsimd::abs(v.x) + xsimd::abs(v.y) + xsimd::abs(v.z);
}

/// Writes the turns of kFloats triangles. corners: by rows; areas: where turns stand.
[[gnu::always_inline]] inline void turn_lanes(const TriangleTurns& t,
                                              const std::uint32_t (&corners)[3][kFloats],
                                              const std::uint32_t* areas, const float* least) {
  const QuadLanes at;
  FloatVector a = at.get(t.starts, corners[0]), way = at.get(t.ways, corners[0]);
  FloatVector p = at.get(t.starts, corners[1]) - a, q = at.get(t.starts, corners[2]) - a;
  FloatVector dp = at.get(t.ways, corners[1]) - way, dq = at.get(t.ways, corners[2]) - way;
  FloatVector from = cross(p, q), by = cross(p, dq) + cross(dp, q);
  const Floats size = size_of(p) + size_of(q) + size_of(dp) + size_of(dq);
  auto* out = reinterpret_cast<float*>(t.turns);
  at.put(out, areas, from);
  at.put(out + 4, areas, from + Floats(0.5f) * by);
  at.put(out + 8, areas, from + by + cross(dp, dq));
  const Floats most = xsimd::max(Floats(t.share) * load(least), Floats(t.rounding) * size);
  at.put(out + 12, areas, {most, most, most});
}

/// Triangles first ... last - 1.
void turn_triangles(const TriangleTurns& turns, std::size_t first, std::size_t last) {
  const TriangleTurns t = turns;
  for (std::size_t i = first; i < last; i += kFloats) {
    std::uint32_t corners[3][kFloats], areas[kFloats];
    alignas(64) float least[kFloats];
    for (std::size_t lane = 0; lane < kFloats; ++lane) {
      const std::size_t triangle = std::min(i + lane, last - 1);
      for (std::size_t k = 0; k < 3; ++k) corners[k][lane] = t.corners[triangle][k];
      areas[lane] = static_cast<std::uint32_t>(4 * triangle);
      least[lane] = t.least_area[triangle];
    }
    turn_lanes(t, corners, areas, least);
  }
}

/// Blocks first ... last - 1.
void find_folded_stars(const StarFold& fold, std::size_t first, std::size_t last) {
  const QuadLanes at;
  const auto* areas = reinterpret_cast<const float*>(fold.turns);
  for (std::size_t i = first; i < last; ++i) {
    const StarBlock block = fold.blocks[i];
    std::uint32_t folded = 0;
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      FloatVector sum = no_vector();
      for (std::uint32_t row = block.first; row < block.last; ++row) {
        const std::uint32_t* triangles = fold.rows[row] + lane;
        sum = sum + at.get(areas, triangles) + at.get(areas + 8, triangles);
      }
      const Floats length = xsimd::sqrt(dot(sum, sum));
      FloatMask faces = length > Floats(0.f);
      for (std::uint32_t row = block.first; row < block.last; ++row) {
        const std::uint32_t* triangles = fold.rows[row] + lane;
        const Floats along = xsimd::min(dot(at.get(areas, triangles), sum),
                                        xsimd::min(dot(at.get(areas + 4, triangles), sum),
                                                   dot(at.get(areas + 8, triangles), sum)));
        faces = faces && along > at.get(areas + 12, triangles).x * length;
      }
      folded |= bits(!faces) << lane;
    }
    fold.folded[i] = static_cast<std::uint16_t>(folded);
  }
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
