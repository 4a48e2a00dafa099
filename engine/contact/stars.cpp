#include "engine/contact/stars.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/erase_repeated.h"
#include "engine/model/rest_lengths.h"
#include "engine/tuning.h"

namespace weft {

using kernels::kLanes;

namespace {

/// Quads of a simd::TriangleTurn.
constexpr std::uint32_t kTurnQuads = sizeof(simd::TriangleTurn) / (4 * sizeof(float));

bool has_face(const TriangleSurface& cloth, std::uint32_t point) {
  return std::ranges::any_of(cloth.triangles_at[point],
                             [&](std::uint32_t t) { return cloth.is_face(t); });
}

/// Whether the triangles around the point are one ring, and all run around it in one sense.
bool are_ring(const TriangleSurface& cloth, std::uint32_t point) {
  const auto triangles = cloth.triangles_at[point];
  if (!std::ranges::all_of(triangles, [&](std::uint32_t t) { return cloth.is_face(t); }))
    return false;
  const auto after = [&](std::uint32_t triangle, std::size_t steps) {
    const TriangleSurface::Triangle& corners = cloth.triangles[triangle];
    const auto at = static_cast<std::size_t>(std::ranges::find(corners, point) - corners.begin());
    return corners[(at + steps) % 3];
  };
  if (triangles.size() < 3 || cloth.is_on_border(point)) return false;
  const std::uint32_t first = after(triangles[0], 1);
  std::uint32_t here = first;
  for (std::size_t turn = 0; turn < triangles.size(); ++turn) {
    std::uint32_t next = kNoIndex;
    for (const std::uint32_t t : triangles) {
      if (after(t, 1) != here) continue;
      if (next != kNoIndex) return false;
      next = after(t, 2);
    }
    if (next == kNoIndex) return false;
    here = next;
    if (here == first) return turn + 1 == triangles.size();
  }
  return false;
}

template <class Range>
bool has(const Range& range, std::uint32_t item) {
  return std::ranges::find(range, item) != std::ranges::end(range);
}

/// Points whose stars have the edge, but for those of a third triangle at it; kNoIndex: there is
/// none.
std::array<std::uint32_t, 4> apexes(const TriangleSurface& cloth, std::uint32_t edge) {
  const auto [a, b] = cloth.edges[edge];
  const auto [c, d] = cloth.opposite[edge];
  return {a, b, c, d};
}

/// The first point of a that b has, too.
template <class A, class B>
std::uint32_t first_common(const A& a, const B& b) {
  std::uint32_t first = kNoIndex;
  for (const std::uint32_t item : a)
    if (item < first && has(b, item)) first = item;
  return first;
}

}  // namespace

void Stars::make(const ContactPoints& points) {
  find_least_areas(points);
  put_in_blocks(points.cloth());
}

void Stars::find_least_areas(const ContactPoints& points) {
  const TriangleSurface& cloth = points.cloth();
  const std::vector<double> lengths = lengths_at_rest(points.model(), cloth);
  const double thickness = points.model().self_contact.thickness;
  for (std::uint32_t t = 0; t < cloth.triangles.size(); ++t) {
    least_area_.push_back(0);
    if (!cloth.is_face(t)) continue;
    const auto [a, b, c] = cloth.edges_of[t];
    const double longest = std::max({lengths[a], lengths[b], lengths[c]});
    const double half = 0.5 * (lengths[a] + lengths[b] + lengths[c]);
    const double square = half * (half - lengths[a]) * (half - lengths[b]) * (half - lengths[c]);
    const double area = 2 * std::sqrt(std::max(0.0, square));
    // The height of the triangle is area / longest. Features keep the thickness from each other, or
    // this share of the distance that they have at rest.
    const double least = std::min(tuning::kRestDistance * area, thickness * longest);
    least_area_.back() = static_cast<float>(least);
  }
}

void Stars::put_in_blocks(const TriangleSurface& cloth) {
  for (std::uint32_t point = 0; point < cloth.triangles_at.size(); ++point) {
    if (has_face(cloth, point)) (are_ring(cloth, point) ? rings_ : open_).push_back(point);
  }
  for (std::size_t first = 0; first < rings_.size(); first += kLanes) {
    const auto of_lane = [&](std::size_t lane) {
      return cloth.triangles_at[rings_[std::min(first + lane, rings_.size() - 1)]];
    };
    std::size_t most = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) most = std::max(most, of_lane(lane).size());
    const auto row = static_cast<std::uint32_t>(rows_.size());
    blocks_.push_back({row, row + static_cast<std::uint32_t>(most)});
    for (std::size_t i = 0; i < most; ++i) {
      rows_.emplace_back();
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const auto triangles = of_lane(lane);
        rows_.back()[lane] = kTurnQuads * triangles[i % triangles.size()];
      }
    }
  }
  folded_.resize(blocks_.size());
  listed_.resize(blocks_.size());
}

void Stars::begin() {
  std::ranges::fill(listed_, std::uint16_t{0});
  has_open_ = false;
}

void Stars::find_folded(const ContactPoints& points, Fold fold, Team& team) {
  const auto& triangles = points.cloth().triangles;
  turns_.resize(triangles.size());
  const simd::TriangleTurns turns{
      .corners = reinterpret_cast<const std::uint32_t(*)[3]>(triangles.data()),
      .least_area = least_area_.data(),
      .starts = points.starts(),
      .ways = points.ways(),
      .share = fold == Fold::comes_near ? 1.f : 0.f,
      .rounding = 4 * points.rounding_of_cloth(),
      .turns = turns_.data()};
  team.for_each_share(triangles.size(), [&](std::size_t first, std::size_t last) {
    kernels_.turn_triangles(turns, first, last);
  });
  const simd::StarFold folds{.blocks = blocks_.data(),
                             .rows = reinterpret_cast<const std::uint32_t(*)[kLanes]>(rows_.data()),
                             .turns = turns_.data(),
                             .folded = folded_.data()};
  team.for_each_share(blocks_.size(), [&](std::size_t first, std::size_t last) {
    kernels_.find_folded_stars(folds, first, last);
  });
}

bool Stars::add_folded(const ContactPoints& points, Fold fold, Candidates& candidates, Team& team) {
  bool any = false;
  if (!std::exchange(has_open_, true)) {
    for (const std::uint32_t star : open_) add(points, star, candidates);
    any = !open_.empty();
  }
  find_folded(points, fold, team);
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    std::uint32_t bits = folded_[block] & ~std::uint32_t{listed_[block]};
    listed_[block] = static_cast<std::uint16_t>(listed_[block] | bits);
    for (; bits != 0; bits &= bits - 1) {
      const std::size_t i = block * kLanes + static_cast<std::size_t>(std::countr_zero(bits));
      if (i >= rings_.size()) break;
      add(points, rings_[i], candidates);
      any = true;
    }
  }
  return any;
}

/// Each pair by the first of the stars that have both of its features. Where three triangles meet
/// at an edge it may be there twice.
void Stars::add(const ContactPoints& points, std::uint32_t star, Candidates& candidates) {
  const TriangleSurface& cloth = points.cloth();
  const auto add_pair = [&](PairKind kind, std::uint32_t first, std::uint32_t second,
                            const std::array<std::uint32_t, 4>& four) {
    if (points.sewn().join(kind, four)) return;
    const Pair pair{first, second, kClothSurface, kClothSurface, kind};
    candidates[star_list_of(kind)].add(pair, four);
  };
  edges_.clear();
  for (const std::uint32_t t : cloth.triangles_at[star]) {
    edges_.insert(edges_.end(), cloth.edges_of[t].begin(), cloth.edges_of[t].end());
    if (!cloth.is_face(t)) continue;
    const auto& corners = cloth.triangles[t];
    for (const std::uint32_t p : cloth.neighbours[star]) {
      if (has(corners, p) || first_common(corners, cloth.neighbours[p]) != star) continue;
      add_pair(PairKind::point_triangle, p, t, {p, corners[0], corners[1], corners[2]});
    }
  }
  std::ranges::sort(edges_);
  erase_repeated(edges_);
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const auto [p, q] = cloth.edges[edges_[i]];
    for (std::size_t j = i + 1; j < edges_.size(); ++j) {
      const auto [r, s] = cloth.edges[edges_[j]];
      if (p == r || p == s || q == r || q == s) continue;
      const std::uint32_t first = first_common(apexes(cloth, edges_[i]), apexes(cloth, edges_[j]));
      if (first != star && first != kNoIndex) continue;
      add_pair(PairKind::edges, edges_[i], edges_[j], {p, q, r, s});
    }
  }
}

bool are_in_one_star(const TriangleSurface& cloth, const Pair& pair) {
  if (pair.kind == PairKind::edges)
    return first_common(apexes(cloth, pair.first), apexes(cloth, pair.second)) != kNoIndex;
  return first_common(cloth.triangles[pair.second], cloth.neighbours[pair.first]) != kNoIndex;
}

std::size_t Stars::bytes() const {
  return bytes_of(least_area_) + bytes_of(open_) + bytes_of(rings_) + bytes_of(blocks_) +
         bytes_of(rows_) + bytes_of(turns_) + bytes_of(folded_) + bytes_of(listed_) +
         bytes_of(edges_);
}

}  // namespace weft
