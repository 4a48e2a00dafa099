#include "engine/crossings.h"

#include <algorithm>

#include "engine/contacts.h"

namespace weft {
namespace {

constexpr double kDeep = 0.05;  // of r1 + r2
/// A way that begins and ends at the surface and is so deep in between is longer than this, in
/// r1 + r2: 2 sqrt(1 - (1 - kDeep)^2).
constexpr double kShortest = 0.62;

/// Least distance from the origin of the points on the way from one place to another.
double least_distance(kernels::Vector from, kernels::Vector to) {
  const kernels::Vector way = to - from;
  const double part = std::clamp(-dot(from, way) / dot(way, way), 0.0, 1.0);
  return length(from + part * way);
}

}  // namespace

std::uint32_t find_crossing(const Model& m, const kernels::Vectors& before,
                            const kernels::Vectors& after) {
  for (const std::uint32_t s : m.spheres) {
    const kernels::Vector start = before[s], moved = after[s] - start;
    for (std::uint32_t p = 0; p < m.slots(); ++p) {
      const double reach = m.radius[s] + m.radius[p];
      const kernels::Vector way = after[p] - before[p] - moved;
      if (!(dot(way, way) > kShortest * kShortest * reach * reach)) continue;
      const kernels::Vector from = before[p] - start, to = from + way;
      const double surface = (1 - kDeep) * reach;
      if (length(from) < surface || least_distance(from, to) >= surface) continue;
      if (length(to) < surface) continue;  // still in there: that is a penetration, and measured
      if (may_touch(m, s, p)) return p;
    }
  }
  return kNoIndex;
}

}  // namespace weft
