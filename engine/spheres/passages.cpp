#include "engine/spheres/passages.h"

#include <algorithm>

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

bool may_have_passed(const Model& m, double way) {
  return std::ranges::any_of(m.spheres,
                             [&](std::uint32_t s) { return !(2 * way < kShortest * m.radius[s]); });
}

std::uint32_t find_passage(const Model& m, const simd::Table& kernels, kernels::VectorsView before,
                           kernels::VectorsView after, SphereContacts& contacts) {
  std::uint32_t* const moved = contacts.found.data();
  contacts.boxes.enclose(m, kernels, {before, after});
  for (const std::uint32_t s : m.spheres) {
    const kernels::Vector start = before[s], along = after[s] - start;
    const double radius = m.radius[s];
    std::size_t far = 0;
    contacts.boxes.visit_near(
        m, kernels, start, after[s], radius, [&](std::size_t first, std::size_t last) {
          far += kernels.find_moved(before, after, along, m.radius.data(), radius, kShortest, first,
                                    last, moved + far);
        });
    for (std::size_t i = 0; i < far; ++i) {
      const std::uint32_t p = moved[i];
      const kernels::Vector from = before[p] - start, to = from + (after[p] - before[p] - along);
      const double surface = (1 - kDeep) * (m.radius[s] + m.radius[p]);
      // (Far away all of a way may be rounded off, and what is least of it is no number.)
      if (!(length(from) >= surface && least_distance(from, to) < surface)) continue;
      if (length(to) < surface) continue;  // still in there: that is a penetration, and measured
      if (may_touch(m, s, p)) return p;
    }
  }
  return kNoIndex;
}

}  // namespace weft
