#include "engine/contact/adjacent_features.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "engine/bytes_of.h"

namespace weft {

using kernels::kLanes;

void AdjacentFeatures::make(const TriangleSurface& cloth, const SewnPoints& sewn) {
  std::vector<std::uint32_t> seen(cloth.triangles.size(), kNoIndex);
  for (std::uint32_t a = 0; a < cloth.triangles.size(); ++a) {
    if (cloth.is_point(a)) continue;
    for (const std::uint32_t corner : cloth.triangles[a]) {
      for (const std::uint32_t b : cloth.triangles_at[corner]) {
        if (b <= a || seen[b] == a) continue;
        seen[b] = a;
        add_features(cloth, sewn, a, b);
      }
    }
  }
}

void AdjacentFeatures::add_features(const TriangleSurface& cloth, const SewnPoints& sewn,
                                    std::uint32_t a, std::uint32_t b) {
  const auto add_apart = [&](PairKind kind, std::uint32_t first, std::uint32_t second,
                             const std::array<std::uint32_t, 4>& points, const Owners& owners) {
    if (!sewn.join(kind, points)) add(kind, first, second, points, owners);
  };
  const auto add_points = [&](std::uint32_t of, std::uint32_t beside) {
    const auto& its = cloth.triangles[beside];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t point = cloth.triangles[of][k];
      if (!cloth.owns_corner(of, k) || std::ranges::find(its, point) != its.end()) continue;
      add_apart(PairKind::point_triangle, point, beside, {point, its[0], its[1], its[2]},
                {of, beside});
    }
  };
  add_points(a, b);
  add_points(b, a);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!cloth.owns_edge(a, i)) continue;
    const std::uint32_t p = cloth.triangles[a][i], q = cloth.triangles[a][(i + 1) % 3];
    for (std::size_t j = 0; j < 3; ++j) {
      const std::uint32_t r = cloth.triangles[b][j], s = cloth.triangles[b][(j + 1) % 3];
      if (!cloth.owns_edge(b, j) || p == r || p == s || q == r || q == s) continue;
      add_apart(PairKind::edges, cloth.edges_of[a][i], cloth.edges_of[b][j], {p, q, r, s}, {a, b});
    }
  }
}

void AdjacentFeatures::add(PairKind kind, std::uint32_t first, std::uint32_t second,
                           const std::array<std::uint32_t, 4>& points, const Owners& owners) {
  const Pair pair{first, second, kClothSurface, kClothSurface, kind};
  const std::size_t list = list_of(pair);
  pairs_[list].add(pair, points);
  owners_[list].push_back(owners);
}

/// A tube is a ball that goes from the middle of one box to that of the other. All is larger by
/// what floats may overestimate a distance.
void AdjacentFeatures::read_tubes(ContactPoints& points) {
  begins_.resize(4 * points.slots());
  ways_.resize(4 * points.slots());
  constexpr float kLarger = 1 / simd::kSurelyApart;
  for (std::uint32_t slot = 0; slot < points.slots(); ++slot) {
    const auto& [begins, ends] = points.tube(slot);
    float at_start = 0, at_end = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const float from = 0.5f * (begins.low[k] + begins.high[k]),
                  to = 0.5f * (ends.low[k] + ends.high[k]);
      begins_[4 * slot + k] = from;
      ways_[4 * slot + k] = kLarger * (to - from);
      at_start += (begins.high[k] - from) * (begins.high[k] - from);
      at_end += (ends.high[k] - to) * (ends.high[k] - to);
    }
    ways_[4 * slot + 3] = kLarger * std::sqrt(std::max(at_start, at_end));
  }
}

simd::PairMeasure AdjacentFeatures::measure_of(const ContactPoints& points, std::size_t list) {
  const std::size_t blocks = pairs_[list].blocks.size();
  if (near_.size() < blocks) {
    near_.resize(blocks);
    distance_.resize(blocks);
  }
  return {.pairs = pairs_[list].blocks.data(),
          .points = begins_.data(),
          .ways = ways_.data(),
          .reach = 64 * points.rounding_of_cloth(),
          .beyond = std::numeric_limits<float>::infinity(),
          .distance = reinterpret_cast<float(*)[kLanes]>(distance_.data()),
          .near = near_.data()};
}

void AdjacentFeatures::add_near(std::size_t list, std::size_t block, std::uint32_t bits,
                                Candidates& candidates) const {
  for (bits &= pairs_[list].used[block]; bits != 0; bits &= bits - 1) {
    const std::size_t i = block * kLanes + static_cast<std::size_t>(std::countr_zero(bits));
    candidates[list].add(pairs_[list].pairs[i], pairs_[list].points(i));
  }
}

void AdjacentFeatures::find(ContactPoints& points, Candidates& candidates, Team& team) {
  read_tubes(points);
  for (std::size_t list = kBodyLists; list < kPairLists; ++list) {
    const simd::PairMeasure measure = measure_of(points, list);
    const std::size_t blocks = pairs_[list].blocks.size();
    team.for_each_share(blocks, [&](std::size_t first, std::size_t last) {
      table_.measure_pairs(measure, has_edges(list), first, last);
    });
    for (std::size_t block = 0; block < blocks; ++block)
      add_near(list, block, near_[block], candidates);
  }
}

void AdjacentFeatures::find_of(ContactPoints& points, std::span<const std::uint8_t> is_marked,
                               Candidates& candidates, Team& team) {
  read_tubes(points);
  for (std::size_t list = kBodyLists; list < kPairLists; ++list) {
    const simd::PairMeasure measure = measure_of(points, list);
    const std::span<const Owners> owners = owners_[list];
    const auto marked_in = [&](std::size_t block) {
      std::uint32_t marked = 0;
      const std::size_t first = block * kLanes,
                        count = std::min<std::size_t>(kLanes, owners.size() - first);
      for (std::size_t lane = 0; lane < count; ++lane) {
        const auto [a, b] = owners[first + lane];
        marked |= (is_marked[a] | is_marked[b] ? 1u : 0u) << lane;
      }
      return marked;
    };
    team.for_each(pairs_[list].blocks.size(), [&](std::size_t block) {
      const std::uint32_t marked = marked_in(block);
      near_[block] = 0;
      if (marked == 0) return;
      table_.measure_pairs(measure, has_edges(list), block, block + 1);
      near_[block] = static_cast<std::uint16_t>(near_[block] & marked);
    });
    for (std::size_t block = 0; block < pairs_[list].blocks.size(); ++block)
      add_near(list, block, near_[block], candidates);
  }
}

std::size_t AdjacentFeatures::bytes() const {
  std::size_t bytes = bytes_of(begins_) + bytes_of(ways_) + bytes_of(distance_) + bytes_of(near_);
  for (std::size_t list = kBodyLists; list < kPairLists; ++list)
    bytes += pairs_[list].bytes() + bytes_of(owners_[list]);
  return bytes;
}

}  // namespace weft
