#include "engine/contact/near.h"

#include <algorithm>
#include <bit>

#include "engine/bytes_of.h"
#include "engine/contact/look.h"
#include "engine/tuning.h"

namespace weft {

using kernels::kLanes;
using kernels::Vector;

namespace {

using Four = std::array<std::uint32_t, 4>;

/// Candidates are those of wide boxes. So that what is near depends on the state alone, and not on
/// when candidates were looked for, boxes of this interval are to meet.
bool may_meet(const ContactPoints& points, PairKind kind, const Four& four) {
  const std::size_t firsts = kind == PairKind::edges ? 2 : 1;
  Box first = points.box(four[0]), second = points.box(four[3]);
  for (std::size_t k = 1; k < 3; ++k) (k < firsts ? first : second).add(points.box(four[k]));
  return first.meets(second);
}

/// m, by which two features come nearer to each other along n at most, if their points go on as
/// expected, but for their reach.
double closing(const ContactPoints& points, PairKind kind, const Four& four, Vector n) {
  const auto by = [&](std::size_t k) { return dot(n, points.way(four[k])); };
  const bool edges = kind == PairKind::edges;
  const double first = edges ? std::min(by(0), by(1)) : by(0);
  const double second = edges ? std::max(by(2), by(3)) : std::max({by(1), by(2), by(3)});
  const auto reach = [&](std::size_t from, std::size_t to) {
    double most = 0;
    for (std::size_t k = from; k < to; ++k) most = std::max(most, points.reach(four[k]));
    return most;
  };
  const std::size_t firsts = edges ? 2 : 1;
  return std::max(0.0, second - first) + (reach(0, firsts) + reach(firsts, 4));
}

/// Whether a pair is to be looked at, and how.
struct Seen {
  bool is_near = false;
  bool is_under = false;
  Vector normal{};
};

Seen see(ContactPoints& points, const Pair& pair, const Four& four, bool is_inside) {
  if (!(points.largest_inverse_mass(four) > 0) || !may_meet(points, pair.kind, four)) return {};
  const FourPoints x = points.starts_of(four);
  ContactSurface& later = points.later(pair);
  const Look seen = look(later, pair, x);
  if (seen.distance - closing(points, pair.kind, four, seen.normal) > points.thickness_of(pair))
    return {};
  const Vector passes = points.way(four[0]) - points.way(four[3]);
  const bool stays = length(passes) < tuning::kContactPassing * seen.distance;
  const auto is_ghost_by = [&](double lean) {
    return is_ghost(points.surfaces(), pair, x, seen.nearest, seen.normal, lean,
                    [&](std::uint32_t point) { return points.start(point); });
  };
  const bool is_placed = stays && is_in_place(pair.kind, seen.nearest);
  if (!is_inside && is_placed && is_ghost_by(tuning::kContactLean)) return {};
  const Seen in_front{.is_near = true, .normal = seen.normal};
  if (later.two_sided || !is_behind(later, pair, seen.nearest)) return in_front;
  // Behind what is not the nearest of its surface the cloth may be beside it.
  if (!is_inside) return !is_placed || is_ghost_by(0) ? in_front : Seen{};
  return {.is_near = true, .is_under = true, .normal = -1.0 * seen.normal};
}

}  // namespace

simd::PairMeasure NearSearch::measure_of(const ContactPoints& points, const PairList& pairs,
                                         Distances& distances) const {
  return {.pairs = pairs.blocks.data(),
          .points = points.starts(),
          .ways = points.ways(),
          .reach = static_cast<float>(points.largest_thickness() + points.largest_reach_of_pair()),
          .beyond = static_cast<float>(tuning::kContactBeyond),
          .distance = reinterpret_cast<float(*)[kLanes]>(distances.distance.data()),
          .near = distances.near.data()};
}

void NearSearch::measure_block(const simd::PairMeasure& measure, std::size_t list,
                               const PairList& pairs, std::size_t block) {
  Distances& d = distances_[list];
  table_.measure_pairs(measure, has_edges(list), block, block + 1);
  d.near[block] = static_cast<std::uint16_t>(d.near[block] & pairs.used[block]);
  float least = d.distance[block][0];
  for (const float distance : d.distance[block]) least = std::min(least, distance);
  d.least[block] = simd::kSurelyApart * least + travelled_;
  d.sleeps[block] = 0;
}

void NearSearch::measure(const ContactPoints& points, const Candidates& candidates, bool have_moved,
                         Team& team) {
  travelled_ = have_moved ? 0 : travelled_ + (1 + 0x1p-20f) * points.travelled();
  for (std::size_t list = 0; list < kPairLists; ++list) {
    const PairList& pairs = candidates[list];
    Distances& d = distances_[list];
    d.resize(pairs.blocks.size());
    const simd::PairMeasure measure = measure_of(points, pairs, d);
    const float near = travelled_ + measure.reach + points.largest_way() + 4 * points.rounding();
    const std::size_t known = have_moved ? 0 : d.count / kLanes;
    team.for_each_share(pairs.blocks.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t block = first; block < last; ++block) {
        if (block < known && d.least[block] > near) {
          d.near[block] = 0;
          d.sleeps[block] = 1;
        } else {
          measure_block(measure, list, pairs, block);
        }
      }
    });
    d.count = pairs.size();
  }
}

void NearSearch::wake(const ContactPoints& points, const Candidates& candidates, std::size_t list,
                      std::size_t block) {
  if (distances_[list].sleeps[block] == 0) return;
  measure_block(measure_of(points, candidates[list], distances_[list]), list, candidates[list],
                block);
}

void NearSearch::measure_new(const ContactPoints& points, const Candidates& candidates,
                             Team& team) {
  for (std::size_t list = 0; list < kPairLists; ++list) {
    const PairList& pairs = candidates[list];
    Distances& d = distances_[list];
    if (d.count == pairs.size()) continue;
    d.resize(pairs.blocks.size());
    const simd::PairMeasure measure = measure_of(points, pairs, d);
    const std::size_t known = d.count / kLanes;
    team.for_each_share(pairs.blocks.size() - known, [&](std::size_t first, std::size_t last) {
      for (std::size_t block = known + first; block < known + last; ++block)
        measure_block(measure, list, pairs, block);
    });
    d.count = pairs.size();
  }
}

void NearSearch::find(ContactPoints& points, const Candidates& candidates, const Tangles& tangles,
                      Near& near) const {
  for (std::size_t list = 0; list < kPairLists; ++list) {
    near[list].clear();
    const PairList& pairs = candidates[list];
    for (std::size_t block = 0; block < distances_[list].near.size(); ++block) {
      for (std::uint32_t bits = distances_[list].near[block]; bits != 0; bits &= bits - 1) {
        const std::size_t i = block * kLanes + static_cast<std::size_t>(std::countr_zero(bits));
        const Pair& pair = pairs.pairs[i];
        const Four four = pairs.points(i);
        const bool is_inside = !pair.is_within_cloth() && tangles.is_inside(four);
        // Faces and edges between particles that are inside follow these.
        const bool is_of_particle = pair.kind == PairKind::point_triangle && !pair.is_turned();
        if ((is_inside && !is_of_particle) || tangles.leaves_out(pair)) continue;
        const Seen seen = see(points, pair, four, is_inside);
        if (!seen.is_near) continue;
        near[list].add(pair, four, seen.normal, points.thickness_of(pair), seen.is_under);
      }
    }
  }
}

std::size_t NearSearch::bytes() const {
  std::size_t bytes = 0;
  for (const Distances& d : distances_)
    bytes += bytes_of(d.distance) + bytes_of(d.near) + bytes_of(d.least) + bytes_of(d.sleeps);
  return bytes;
}

}  // namespace weft
