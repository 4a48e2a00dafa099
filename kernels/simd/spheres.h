/// Contacts of one sphere s with particles p: which are near enough to be watched, which moved so
/// far that they may have gone through, boxes that spare most of them the question, and one pass
/// over them. They push only: the sum of their corrections, in units of e, stays at or below 0.
///
/// kLanes contacts are taken at once, whatever the width of a vector. They share the sphere, so
/// each is corrected as if the sphere's mass were divided among them (mass splitting: never too
/// much, however light the sphere, and next to nothing lost where it is heavy):
///
///     gain_b = tau^2 w_p / (w_p + kLanes w_s),   gain_a = -tau^2 w_s / (w_p + kLanes w_s)
///
/// and the sphere moves by the sum of what they do to it, added in one order.
#pragma once

#include <algorithm>

#include "kernels/simd/relax.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// The slots of the lanes in the mask; returns how many.
[[gnu::always_inline]] inline std::size_t list(DoubleMask mask, std::size_t slot,
                                               std::uint32_t* out) {
  if (!xsimd::any(mask)) return 0;
  bool lanes[kDoubles];
  mask.store_unaligned(lanes);
  std::size_t listed = 0;
  for (std::uint32_t k = 0; k < kDoubles; ++k) {
    if (lanes[k]) out[listed++] = static_cast<std::uint32_t>(slot + k);
  }
  return listed;
}

/// Grows by the places of the lanes in the mask; what is not a number is in no box.
struct BoxLanes {
  DoubleVector low, high;

  [[gnu::always_inline]] void take(const DoubleVector& at, DoubleMask mask) {
    take(at.x, mask, low.x, high.x);
    take(at.y, mask, low.y, high.y);
    take(at.z, mask, low.z, high.z);
  }
  [[gnu::always_inline]] static void take(Doubles at, DoubleMask mask, Doubles& low,
                                          Doubles& high) {
    low = xsimd::select(mask & (at < low), at, low);
    high = xsimd::select(mask & (at > high), at, high);
  }
};

[[gnu::always_inline]] inline double least(Doubles d) {
  alignas(64) double lanes[kDoubles];
  d.store_aligned(lanes);
  return *std::ranges::min_element(lanes);
}
[[gnu::always_inline]] inline double greatest(Doubles d) {
  alignas(64) double lanes[kDoubles];
  d.store_aligned(lanes);
  return *std::ranges::max_element(lanes);
}
[[gnu::always_inline]] inline DoubleVector in_all_lanes(kernels::Vector v) {
  return {Doubles(v.x), Doubles(v.y), Doubles(v.z)};
}

void bound(kernels::VectorsView x, const double* mass, std::size_t slots, const Boxes& boxes) {
  for (std::size_t box = 0; box * kBoxed < slots; ++box) {
    BoxLanes lanes{in_all_lanes(boxes.low[box]), in_all_lanes(boxes.high[box])};
    const std::size_t last = std::min(slots, (box + 1) * kBoxed);
    for (std::size_t i = box * kBoxed; i < last; i += kDoubles) {
      lanes.take(load(x, i), load(mass + i) > Doubles(0.));
    }
    boxes.low.set(box, {least(lanes.low.x), least(lanes.low.y), least(lanes.low.z)});
    boxes.high.set(box, {greatest(lanes.high.x), greatest(lanes.high.y), greatest(lanes.high.z)});
  }
}

/// A box is left out where on one axis the gap is wider than the reach. How far things in two boxes
/// are from each other is computed from their places and ways, and off by a few roundings of the
/// gap and of the extents: kRounding of all that is more. Where an extent is infinite or not a
/// number no gap is wider.
std::size_t find_boxes(const Boxes& boxes, kernels::Vector low, kernels::Vector high, double extra,
                       std::uint32_t* out) {
  constexpr double kRounding = 1e-12;
  const double width = high.x - low.x + (high.y - low.y) + (high.z - low.z);
  DoubleVector from = in_all_lanes(low), to = in_all_lanes(high);
  std::size_t found = 0;
  for (std::size_t i = 0; i < boxes.count; i += kDoubles) {
    DoubleVector first = load(boxes.low, i), last = load(boxes.high, i);
    DoubleVector before = first - to, behind = from - last, extent = last - first;
    const Doubles gap =
        xsimd::max(xsimd::max(xsimd::max(before.x, before.y), xsimd::max(before.z, behind.x)),
                   xsimd::max(behind.y, behind.z));
    const Doubles reach = load(boxes.reach + i) + Doubles(extra);
    const Doubles all = extent.x + extent.y + extent.z + Doubles(width) + reach;
    found += list(!(gap > fused(Doubles(kRounding), all, reach)), i, out + found);
  }
  return found;
}

std::size_t find_near(kernels::VectorsView x, const double* reach, kernels::Vector centre,
                      double extra, std::size_t first, std::size_t last, std::uint32_t* out) {
  DoubleVector c = in_all_lanes(centre);
  std::size_t found = 0;
  for (std::size_t i = first; i < last; i += kDoubles) {
    DoubleVector d = load(x, i) - c;
    const Doubles limit = load(reach + i) + Doubles(extra);
    found += list(dot(d, d) < limit * limit, i, out + found);
  }
  return found;
}

std::size_t find_moved(kernels::VectorsView before, kernels::VectorsView after,
                       kernels::Vector along, const double* reach, double extra, double part,
                       std::size_t first, std::size_t last, std::uint32_t* out) {
  DoubleVector with = in_all_lanes(along);
  std::size_t found = 0;
  for (std::size_t i = first; i < last; i += kDoubles) {
    DoubleVector way = load(after, i) - load(before, i) - with;
    const Doubles limit = Doubles(part) * (load(reach + i) + Doubles(extra));
    found += list(dot(way, way) > limit * limit, i, out + found);
  }
  return found;
}

/// Sum of kLanes numbers as a balanced tree.
[[gnu::always_inline]] inline float tree_sum(float* lanes) {
  for (std::uint32_t half = kernels::kLanes / 2; half > 0; half /= 2) {
    for (std::uint32_t k = 0; k < half; ++k) lanes[k] += lanes[k + half];
  }
  return lanes[0];
}

template <class Lanes>
[[gnu::always_inline]] inline std::uint32_t relax_touching(const BlockRelaxation& r,
                                                           std::uint32_t first,
                                                           std::uint32_t last) {
  const Floats threshold(r.threshold);
  const std::size_t sphere = r.a[first] * r.u.step;
  std::uint32_t corrections = 0;
  Lanes at_b;
  for (std::size_t block = first; block < last; block += kernels::kLanes) {
    FloatVector us{Floats(r.u.x[sphere]), Floats(r.u.y()[sphere]), Floats(r.u.z()[sphere])};
    LaneVectors pushes;
    std::uint32_t corrected_here = 0;
    for (std::uint32_t k = 0; k < kernels::kLanes; k += kFloats) {
      const std::size_t c = block + k;
      const Part p = part(r, c);
      FloatVector n = p.n();
      FloatVector up = at_b.get(r.u, r.b + c);
      Corrected corrected = correct_one_sided<Side::pushes>(r, c, errors(p, n, us - up), threshold);
      const std::uint32_t corrected_lanes = count(corrected.lanes);
      store(pushes, k, corrected.by * p.gain_a() * n);
      if (corrected_lanes == 0) continue;
      corrected_here += corrected_lanes;
      up = fused(corrected.by * p.gain_b(), n, up);
      at_b.put(r.u, r.b + c, up);
    }
    corrections += corrected_here;
    if (corrected_here == 0) continue;
    r.u.x[sphere] += tree_sum(pushes.x);
    r.u.y()[sphere] += tree_sum(pushes.y);
    r.u.z()[sphere] += tree_sum(pushes.z);
  }
  return corrections;
}

std::uint32_t relax_contacts(const BlockRelaxation& r, std::uint32_t first, std::uint32_t last) {
  return r.u.in_quads() ? relax_touching<QuadLanes>(r, first, last)
                        : relax_touching<PlanarLanes>(r, first, last);
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
