#include "engine/contact/near.h"

#include <algorithm>

#include "engine/bytes_of.h"
#include "engine/contact/look.h"
#include "engine/tuning.h"

namespace weft {

using kernels::kLanes;
using kernels::Vector;

void NearPairs::add(const Pair& pair, const std::array<std::uint32_t, 4>& points, Vector normal,
                    double thickness, bool is_under) {
  const std::size_t lane = list.size() % kLanes;
  if (lane == 0) sides.emplace_back();
  list.add(pair, points);
  sides.back().used |= 1u << lane;
  sides.back().thickness[lane] = static_cast<float>(thickness);
  states.push_back({.is_under = is_under});
  set_normal(list.size() - 1, normal);
}

Vector NearPairs::normal(std::size_t i) const {
  const simd::LaneVectors& n = sides[i / kLanes].normal;
  const std::size_t lane = i % kLanes;
  return {static_cast<double>(n.x[lane]), static_cast<double>(n.y[lane]),
          static_cast<double>(n.z[lane])};
}

void NearPairs::set_normal(std::size_t i, Vector normal) {
  simd::LaneVectors& n = sides[i / kLanes].normal;
  const std::size_t lane = i % kLanes;
  n.x[lane] = static_cast<float>(normal.x);
  n.y[lane] = static_cast<float>(normal.y);
  n.z[lane] = static_cast<float>(normal.z);
}

void NearSearch::measure(const ContactPoints& points, const Candidates& candidates, Team& team) {
  for (std::size_t list = 0; list < kPairLists; ++list) {
    const PairList& pairs = candidates[list];
    Distances& to = distances_[list];
    to.resize(pairs.blocks.size());
    simd::PairMeasure measure{
        .pairs = pairs.blocks.data(),
        .points = points.starts(),
        .ways = points.ways(),
        .reach = static_cast<float>(points.largest_thickness() + points.largest_reach()),
        .beyond = static_cast<float>(tuning::kContactBeyond),
        .distance = reinterpret_cast<float(*)[kLanes]>(to.distance.data()),
        .near = to.near.data()};
    team.for_each_share(pairs.blocks.size(), [&](std::size_t first, std::size_t last) {
      table_.measure_pairs(measure, has_edges(list), first, last);
    });
    if (pairs.size() % kLanes != 0)
      to.near.back() =
          static_cast<std::uint16_t>(to.near.back() & ((1u << pairs.size() % kLanes) - 1));
  }
}

void NearSearch::find_near(const Model& model, ContactPoints& points, const Candidates& candidates,
                           Near& near, const Misplaced& misplaced, const Tangles& tangles) const {
  for (std::size_t list = 0; list < kPairLists; ++list) {
    near[list].clear();
    const PairList& pairs = candidates[list];
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if ((distances_[list].near[i / kernels::kLanes] >> i % kernels::kLanes & 1) == 0) continue;
      const Pair& pair = pairs.pairs[i];
      const std::array<std::uint32_t, 4> four = pairs.points(i);
      const bool inside = std::ranges::any_of(four, [&](std::uint32_t point) {
        return points.is_of_cloth(point) && misplaced.is_inside(point);
      });
      // Faces and edges between particles that are inside follow these.
      if (inside && pair.kind != PairKind::particle_triangle) continue;
      if (tangles.leaves_out(pair)) continue;
      kernels::Vector normal{};
      bool is_under = false;
      if (!see(model, points, pair, four, inside, normal, is_under)) continue;
      near[list].add(pair, four, normal, points.meshes()[pair.mesh].thickness, is_under);
    }
  }
}

bool NearSearch::can_move(const Model& model, const Pair& pair,
                          const std::array<std::uint32_t, 4>& points) {
  const auto is_free = [&](std::uint32_t slot) { return model.inverse_mass[slot] > 0; };
  switch (pair.kind) {
    case PairKind::particle_triangle:
      return is_free(points[0]);
    case PairKind::vertex_triangle:
      return is_free(points[1]) || is_free(points[2]) || is_free(points[3]);
    case PairKind::edges:
      return is_free(points[0]) || is_free(points[1]);
  }
  return false;
}

/// Candidates are those of hulls. So that what is near depends on the state alone, and not on when
/// candidates were looked for, boxes of this interval are to meet.
bool NearSearch::may_meet(const ContactPoints& points, PairKind kind,
                          const std::array<std::uint32_t, 4>& four) {
  const std::size_t firsts = kind == PairKind::edges ? 2 : 1;
  Box first = points.box(four[0]), second = points.box(four[3]);
  for (std::size_t k = 1; k < 3; ++k) (k < firsts ? first : second).add(points.box(four[k]));
  return first.meets(second);
}

/// m, by which two features come nearer to each other along n at most, if their points go on as
/// expected, but for their reach.
double NearSearch::closing(const ContactPoints& points, PairKind kind,
                           const std::array<std::uint32_t, 4>& four, Vector n) {
  const auto by = [&](std::size_t k) { return dot(n, points.way(four[k])); };
  const bool edges = kind == PairKind::edges;
  const double first = edges ? std::min(by(0), by(1)) : by(0);
  const double second = edges ? std::max(by(2), by(3)) : std::max({by(1), by(2), by(3)});
  double reach = 0;
  for (const std::uint32_t point : four) reach = std::max(reach, points.reach(point));
  return std::max(0.0, second - first) + reach;
}

bool NearSearch::see(const Model& model, ContactPoints& points, const Pair& pair,
                     const std::array<std::uint32_t, 4>& four, bool is_inside, Vector& normal,
                     bool& is_under) {
  if (!can_move(model, pair, four) || !may_meet(points, pair.kind, four)) return false;
  const auto at = [&](std::uint32_t point) { return points.start(point); };
  const FourPoints x{at(four[0]), at(four[1]), at(four[2]), at(four[3])};
  const reference::Nearest found = nearest(pair.kind, x);
  const double l = length(found.r);
  ContactMesh& mesh = points.meshes()[pair.mesh];
  normal = direction_apart(mesh, pair, found);
  if (l - closing(points, pair.kind, four, normal) > mesh.thickness) return false;
  const Vector passes = points.way(four[0]) - points.way(four[3]);
  const bool stays = length(passes) < tuning::kContactPassing * l;
  const auto is_ghost_by = [&](double lean) {
    return is_ghost(model.touched_surface(), mesh, pair, x, found,
                    towards_cloth(pair.kind) * normal, lean, at);
  };
  const bool is_placed = stays && is_in_place(pair.kind, found);
  if (!is_inside && is_placed && is_ghost_by(tuning::kContactLean)) return false;
  if (mesh.mesh().two_sided) return true;
  if (!is_behind(mesh, pair, found, towards_cloth(pair.kind) * found.r)) return true;
  // Behind what is not the nearest of its surface the cloth may be beside it.
  if (!is_inside) return !is_placed || is_ghost_by(0);
  is_under = true;
  normal = -1.0 * normal;
  return true;
}

std::size_t NearSearch::bytes() const {
  std::size_t bytes = 0;
  for (const Distances& d : distances_) bytes += bytes_of(d.distance) + bytes_of(d.near);
  return bytes;
}

}  // namespace weft
