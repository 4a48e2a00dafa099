#include "engine/contact/verify.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "engine/contact/look.h"

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

/// A time before the features come nearer than a tenth of the thickness, or of their first distance
/// if that is less, if they do.
std::optional<double> time_of_meeting(PairKind kind, const PairMotion& way, double distance,
                                      double thickness) {
  constexpr double kLeft = 0.1, kStep = 0.9;
  constexpr int kMostSteps = 200;
  const double move = largest_move(kind, way),
               least = kLeft * std::min(distance, std::max(thickness, kLeft * distance));
  double time = 0, here = distance;
  for (int i = 0; i < kMostSteps; ++i) {
    const double next = time + kStep * (here - 0.5 * least) / move;
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
    const double least = distance > kTouching ? 0 : -kTouching * length(n);  // rounding
    return separation(kind, way.from, n) > least && separation(kind, way.to, n) > 0;
  };
  if (separates(r)) return std::nullopt;
  const Vector end = nearest(kind, way.to).r;
  if (separates(end) || separates(r + end)) return std::nullopt;
  return time_of_meeting(kind, way, distance, thickness);
}

}  // namespace

void Verification::find(const ContactScene& scene, const CandidateSearch& broad, NearSearch& narrow,
                        Candidates& candidates, Team& team) {
  failures_.clear();
  look_beside_strayed(scene, broad, narrow, candidates, team);
  const ContactPoints& points = scene.points;
  const auto is_inside = [&](std::uint32_t point) {
    return points.is_of_cloth(point) && scene.misplaced.is_inside(point);
  };
  for (std::uint32_t list = 0; list < kPairLists; ++list) {
    const PairList& pairs = candidates[list];
    find_moved(scene, narrow, candidates, list, 0, team);
    for (std::size_t block = 0; block < moved_.size(); ++block) {
      for (std::uint32_t bits = moved_[block]; bits != 0; bits &= bits - 1) {
        const std::size_t i = block * kLanes + static_cast<std::size_t>(std::countr_zero(bits));
        if (i >= pairs.size()) continue;
        const Pair& pair = pairs.pairs[i];
        if (scene.tangles.leaves_out(pair)) continue;
        PairMotion way;
        const auto four = pairs.points(i);
        for (std::size_t k = 0; k < 4; ++k) {
          way.from[k] = points.start(four[k]);
          way.to[k] = points.end(four[k]);
        }
        const reference::Nearest found = nearest(pair.kind, way.from);
        ContactMesh& mesh = scene.points.meshes()[pair.mesh];
        const double distance = std::max(length(found.r), kTouching);
        const Vector r = distance > kTouching ? found.r : direction_apart(mesh, pair, found);
        const auto time = meeting(pair.kind, way, r, distance, mesh.thickness);
        if (!time) continue;
        // It comes out, which is what it should.
        if (!mesh.mesh().two_sided && std::ranges::any_of(four, is_inside)) continue;
        failures_.push_back({list, static_cast<std::uint32_t>(i), *time, 0});
      }
    }
  }
  leave_each_once(candidates);
}

/// Which pairs of a list may have come nearer than `near`.
void Verification::find_moved(const ContactScene& scene, const NearSearch& narrow,
                              const Candidates& candidates, std::uint32_t list, double near,
                              Team& team) {
  const PairList& pairs = candidates[list];
  moved_.resize(pairs.blocks.size());
  const simd::PairMoves moves{.pairs = pairs.blocks.data(),
                              .moves = scene.points.moves(),
                              .distance = reinterpret_cast<const float(*)[kLanes]>(
                                  narrow.distances()[list].distance.data()),
                              .rounding = scene.points.rounding() + static_cast<float>(near),
                              .moved = moved_.data()};
  team.for_each_share(pairs.blocks.size(), [&](std::size_t first, std::size_t last) {
    table_.find_moved_pairs(moves, has_edges(list), first, last);
  });
}

void Verification::find_late(const ContactScene& scene, NearSearch& narrow,
                             const Candidates& candidates, Team& team) {
  failures_.clear();
  const ContactPoints& points = scene.points;
  const auto at = [&](std::uint32_t point) { return points.end(point); };
  const auto is_inside = [&](std::uint32_t point) {
    return points.is_of_cloth(point) && scene.misplaced.is_inside(point);
  };
  for (std::uint32_t list = 0; list < kPairLists; ++list) {
    const PairList& pairs = candidates[list];
    find_moved(scene, narrow, candidates, list, points.largest_thickness(), team);
    for (std::size_t block = 0; block < moved_.size(); ++block) {
      for (std::uint32_t bits = moved_[block]; bits != 0; bits &= bits - 1) {
        const std::size_t i = block * kLanes + static_cast<std::size_t>(std::countr_zero(bits));
        if (i >= pairs.size()) continue;
        const Pair& pair = pairs.pairs[i];
        if (scene.tangles.leaves_out(pair)) continue;
        const ContactMesh& mesh = points.meshes()[pair.mesh];
        const auto four = pairs.points(i);
        const FourPoints x{at(four[0]), at(four[1]), at(four[2]), at(four[3])};
        const reference::Nearest found = nearest(pair.kind, x);
        const double l = length(found.r);
        constexpr double kLate = 0.99;  // of the thickness: what is nearer is no rounding
        if (!(l < kLate * mesh.thickness) || l == 0 || !is_in_place(pair.kind, found)) continue;
        const Vector n = (towards_cloth(pair.kind) / l) * found.r;
        constexpr double kLean = 0.02;
        if (is_ghost(scene.cloth, mesh, pair, x, found, n, kLean, at)) continue;
        if (!mesh.mesh().two_sided && std::ranges::any_of(four, is_inside)) continue;
        failures_.push_back({list, static_cast<std::uint32_t>(i), 1, mesh.thickness - l});
      }
    }
  }
  leave_each_once(candidates);
}

/// A pair may be among the candidates twice. In an order that does not depend on theirs.
void Verification::leave_each_once(const Candidates& candidates) {
  const auto key = [&](const Failure& f) {
    const Pair& pair = candidates[f.list].pairs[f.pair];
    return std::array{static_cast<std::uint32_t>(pair.kind), std::uint32_t{pair.mesh},
                      pair.of_cloth, pair.of_body};
  };
  std::ranges::sort(failures_, {}, key);
  const auto rest = std::ranges::unique(failures_, {}, key);
  failures_.erase(rest.begin(), rest.end());
}

/// Boxes hold what points were expected to do. Of those that did something else candidates are
/// found anew, by boxes around the ways of their triangles.
void Verification::look_beside_strayed(const ContactScene& scene, const CandidateSearch& broad,
                                       NearSearch& narrow, Candidates& candidates, Team& team) {
  ContactPoints& points = scene.points;
  has_strayed_.assign(points.slots(), 0);
  bool any = false;
  for (std::uint32_t slot = 0; slot < points.slots(); ++slot) {
    if (!scene.model.is_particle(slot) || points.holds_end(slot)) continue;
    points.take_way_in(slot);
    has_strayed_[slot] = 1;
    any = true;
  }
  if (!any) return;
  for (std::uint32_t t = 0; t < scene.cloth.triangles.size(); ++t) {
    const auto [a, b, c] = scene.cloth.triangles[t];
    if ((has_strayed_[a] | has_strayed_[b] | has_strayed_[c]) == 0) continue;
    Box box = points.box(a);
    box.add(points.box(b));
    box.add(points.box(c));
    broad.find_beside(scene.cloth, points, t, box, candidates);
  }
  narrow.measure(points, candidates, team);
  scene.points.forget_hulls();
}

}  // namespace weft
