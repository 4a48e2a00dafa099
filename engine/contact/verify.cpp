#include "engine/contact/verify.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/contact/look.h"
#include "engine/erase_repeated.h"

namespace weft {

using kernels::kLanes;
using kernels::Vector;

namespace {

struct PairMotion {
  FourPoints from{}, to{};

  FourPoints at(double time) const {
    FourPoints x;
    for (std::size_t k = 0; k < 4; ++k) x[k] = from[k] + time * (to[k] - from[k]);
    return x;
  }
};

/// By how much all of the first feature is beyond all of the second along n.
double separation(PairKind kind, const FourPoints& x, Vector n) {
  const auto height = [&](std::size_t k) { return dot(n, x[k]); };
  if (kind == PairKind::edges)
    return std::min(height(0), height(1)) - std::max(height(2), height(3));
  return height(0) - std::max({height(1), height(2), height(3)});
}

/// m, that a point of one feature moves beside one of the other, at most.
double largest_move(PairKind kind, const PairMotion& way) {
  const std::size_t firsts = kind == PairKind::edges ? 2 : 1;
  double most = 0;
  for (std::size_t i = 0; i < firsts; ++i) {
    for (std::size_t j = firsts; j < 4; ++j) {
      const Vector d = (way.to[i] - way.from[i]) - (way.to[j] - way.from[j]);
      most = std::max(most, dot(d, d));
    }
  }
  return std::sqrt(most);
}

/// m: features that are apart stay so far apart, or they would be on no side of each other.
double stays_apart(double distance) {
  return distance >= tuning::kStaysApart ? tuning::kStaysApart : 0;
}

/// Whether the nearest points of both features are fixed, but for rounding: pins that lie on each
/// other stay so, and cloth that hangs on them turns about them.
bool touches_where_held(const ContactPoints& points, const std::array<std::uint32_t, 4>& four,
                        const reference::Nearest& nearest) {
  constexpr double kRounding = 1e-9;
  for (std::size_t k = 0; k < 4; ++k) {
    if (std::abs(nearest.weight[k]) > kRounding && points.inverse_mass(four[k]) > 0) return false;
  }
  return true;
}

/// Beside triangles that cross and are pulled apart: a contour may come to the pair and go on
/// beyond it in one interval.
bool is_drawn_through(const ContactScene& scene, const Pair& pair,
                      const std::array<std::uint32_t, 4>& four) {
  return scene.model.self_contact.untangle && pair.is_within_cloth() &&
         scene.tangles.cross_beside(pair, four);
}

/// A time before the features come nearer than a tenth of the thickness, or of their first distance
/// if that is less, if they do.
std::optional<double> time_of_meeting(PairKind kind, const PairMotion& way, double distance,
                                      double thickness) {
  using tuning::kMeetingLeft;
  const double move = largest_move(kind, way),
               part =
                   kMeetingLeft * std::min(distance, std::max(thickness, kMeetingLeft * distance)),
               least = std::max(part, stays_apart(distance));
  double time = 0, here = distance;
  for (int i = 0; i < tuning::kMeetingSteps; ++i) {
    const double next = time + tuning::kMeetingStep * (here - 0.5 * least) / move;
    if (next >= 1) return std::nullopt;
    here = length(nearest(kind, way.at(next)).r);
    if (here < least) return time;
    time = next;
  }
  return time;
}

/// r: from the second feature to the first, or a unit vector of that kind where they touch.
std::optional<double> meeting(PairKind kind, const PairMotion& way, Vector r, double distance,
                              double thickness) {
  const auto separates = [&](Vector n) {
    if (distance <= kTouching)  // rounding
      return separation(kind, way.from, n) > -kTouching * length(n) &&
             separation(kind, way.to, n) > 0;
    return separation(kind, way.from, n) > 0 &&
           separation(kind, way.to, n) > stays_apart(distance) * length(n);
  };
  if (separates(r)) return std::nullopt;
  const Vector end = nearest(kind, way.to).r;
  if (separates(end) || separates(r + end)) return std::nullopt;
  return time_of_meeting(kind, way, distance, thickness);
}

}  // namespace

/// Calls judge(pair, points, is_alone) for each pair of the first `lists` of candidates that may
/// have come nearer than `near` and is not left alone, and fails those that it says. Threads judge;
/// one thread judges again, alone, the pairs that ask for it.
template <class Judge>
void Verification::judge_moved(const ContactScene& scene, const NearSearch& near_search,
                               const Candidates& candidates, std::size_t lists, double near,
                               Team& team, Judge&& judge) {
  if (std::ranges::all_of(candidates, [](const PairList& list) { return list.size() == 0; }))
    return;
  const float most = scene.points.largest_move() + 4 * scene.points.rounding();
  for (std::uint32_t list = 0; list < lists; ++list) {
    const PairList& pairs = candidates[list];
    moved_.resize(pairs.blocks.size());
    const float spare = static_cast<float>(near) + near_search.travelled();
    const simd::PairMoves moves{.pairs = pairs.blocks.data(),
                                .moves = scene.points.moves(),
                                .distance = near_search.distances()[list].lanes(),
                                .rounding = scene.points.rounding() + spare,
                                .most = most,
                                .moved = moved_.data()};
    team.for_each_share(pairs.blocks.size(), [&](std::size_t first, std::size_t last) {
      table_.find_moved_pairs(moves, has_edges(list), first, last);
    });
    looked_at_.clear();
    for (std::size_t block = 0; block < moved_.size(); ++block) {
      for (std::uint32_t bits = moved_[block] & pairs.used[block]; bits != 0; bits &= bits - 1) {
        const std::size_t i = block * kLanes + static_cast<std::size_t>(std::countr_zero(bits));
        if (!scene.tangles.leaves_out(pairs.pairs[i]))
          looked_at_.push_back(static_cast<std::uint32_t>(i));
      }
    }
    if (verdicts_.size() < looked_at_.size()) verdicts_.resize(looked_at_.size());
    const auto judged = [&](std::size_t k, bool is_alone) {
      const std::uint32_t i = looked_at_[k];
      return judge(pairs.pairs[i], pairs.points(i), is_alone);
    };
    team.for_each(looked_at_.size(), [&](std::size_t k) { verdicts_[k] = judged(k, false); });
    for (std::size_t k = 0; k < looked_at_.size(); ++k) {
      const Verdict verdict = verdicts_[k].asks ? judged(k, true) : verdicts_[k];
      if (verdict.fails) failures_.push_back({list, looked_at_[k], verdict.time, verdict.depth});
    }
  }
}

void Verification::find(const ContactScene& scene, CandidateSearch& search, NearSearch& near_search,
                        Candidates& candidates, Team& team) {
  failures_.clear();
  look_beside_strayed(scene, search, near_search, candidates, team);
  ContactPoints& points = scene.points;
  if (points.touches_itself() && search.find_folded(points, candidates, team))
    near_search.measure_new(points, candidates, team);
  judge_moved(
      scene, near_search, candidates, kPairLists, 0, team,
      [&](const Pair& pair, const std::array<std::uint32_t, 4>& four, bool is_alone) -> Verdict {
        const PairMotion way{points.starts_of(four), points.ends_of(four)};
        ContactSurface& later = points.later(pair);
        Look seen = look_apart(pair, way.from);
        if (!seen.is_apart()) {
          if (!is_alone) return {.asks = true};
          seen = look(later, pair, way.from);
        }
        if (!seen.is_apart() && touches_where_held(points, four, seen.nearest)) return {};
        const double distance = std::max(seen.distance, kTouching);
        const Vector r = distance > kTouching ? seen.nearest.r : seen.normal;
        const auto time = meeting(pair.kind, way, r, distance, points.thickness_of(pair));
        // A particle that comes out does what it should.
        if (!time || (!later.two_sided && scene.tangles.is_inside(four))) return {};
        if (is_drawn_through(scene, pair, four)) return {};
        return {.fails = true, .time = *time};
      });
  leave_each_once(candidates);
}

void Verification::find_late(const ContactScene& scene, const NearSearch& near_search,
                             const Candidates& candidates, Team& team) {
  failures_.clear();
  const ContactPoints& points = scene.points;
  if (points.surface_pairs().empty()) return;  // layers press each other, and come apart slowly
  const auto at = [&](std::uint32_t point) { return points.end(point); };
  judge_moved(
      scene, near_search, candidates, kBodyLists, points.largest_thickness(), team,
      [&](const Pair& pair, const std::array<std::uint32_t, 4>& four, bool) -> Verdict {
        const ContactSurface& later = points.later(pair);
        const FourPoints x = points.ends_of(four);
        const reference::Nearest found = nearest(pair.kind, x);
        const double l = length(found.r);
        const double thickness =
            later.thickness - scene.thinning(four, found.weight, later.body).by;
        if (!(l < tuning::kLate * thickness) || l == 0 || !is_in_place(pair.kind, found)) return {};
        if (is_ghost(points.surfaces(), pair, x, found, (1 / l) * found.r, tuning::kTouchLean, at))
          return {};
        if (!later.two_sided && scene.tangles.is_inside(four)) return {};
        return {.fails = true, .time = 1, .depth = thickness - l};
      });
  leave_each_once(candidates);
}

/// A pair may be among the candidates twice. In an order that does not depend on theirs.
void Verification::leave_each_once(const Candidates& candidates) {
  const auto key = [&](const Failure& f) {
    const Pair& pair = candidates[f.list].pairs[f.pair];
    const auto [earlier, later] =
        pair.is_turned() ? std::pair(pair.second, pair.first) : std::pair(pair.first, pair.second);
    return std::array{static_cast<std::uint32_t>(pair.kind), std::uint32_t{pair.a},
                      std::uint32_t{pair.b}, earlier, later};
  };
  std::ranges::sort(failures_, {}, key);
  erase_repeated(failures_, key);
}

/// Boxes hold the expected places of points. Candidates of points that went elsewhere are found
/// anew, by boxes around the ways of their triangles.
void Verification::look_beside_strayed(const ContactScene& scene, CandidateSearch& search,
                                       NearSearch& near_search, Candidates& candidates,
                                       Team& team) {
  ContactPoints& points = scene.points;
  has_strayed_.assign(points.slots(), 0);
  bool any = false;
  for (std::uint32_t slot = 0; slot < points.slots(); ++slot) {
    if (!scene.model.is_particle(slot) || points.holds_end(slot)) continue;
    points.take_way_in(slot);
    points.touches_itself() ? points.widen_tube_to_way(slot) : points.forget_tube(slot);
    has_strayed_[slot] = 1;
    any = true;
  }
  if (!any) return;
  for (std::uint32_t t = 0; t < points.cloth().triangles.size(); ++t) {
    const auto [a, b, c] = points.cloth().triangles[t];
    if ((has_strayed_[a] | has_strayed_[b] | has_strayed_[c]) == 0) continue;
    Box box = points.box(a);
    box.add(points.box(b));
    box.add(points.box(c));
    search.find_beside(points, t, box, candidates);
  }
  if (points.touches_itself()) search.find_within_cloth_beside(points, has_strayed_, candidates);
  near_search.measure_new(points, candidates, team);
}

}  // namespace weft
