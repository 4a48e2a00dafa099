#include "engine/contact/rest_distances.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <functional>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

#include "engine/contact/look.h"
#include "engine/erase_repeated.h"
#include "engine/model/rest_lengths.h"
#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::Vector;
using Corners = std::array<Vector, 3>;

/// Over the way from 0 to l along x, so far from both ends.
Vector corner(double l, double from_start, double from_end, double side) {
  if (!(l > 0)) return {from_start, 0, 0};
  const double x = (from_start * from_start - from_end * from_end + l * l) / (2 * l);
  return {x, side * std::sqrt(std::max(0.0, from_start * from_start - x * x)), 0};
}

/// m, per point: the least height of its faces, or 0 where they do not go all around it, or seams
/// join others to it. Nothing but what is at a corner of a face comes nearer to it than the least
/// of its three corners has: a way from it leaves all faces at its corners across the height of
/// one.
std::vector<double> clear_around_points(const TriangleSurface& s,
                                        const std::vector<double>& lengths,
                                        const SewnPoints& sewn) {
  const std::size_t points = s.triangles_at.size();
  std::vector<double> clear(points, std::numeric_limits<double>::infinity());
  for (std::uint32_t point = 0; point < points; ++point) {
    const std::size_t triangles = s.triangles_at[point].size();
    if (s.neighbours[point].size() != triangles || sewn.triangles_at(s, point).size() != triangles)
      clear[point] = 0;
  }
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    if (!s.is_face(t)) continue;
    const auto [ab, bc, ca] = s.edges_of[t];
    const double longest = std::max({lengths[ab], lengths[bc], lengths[ca]});
    const double twice_area = lengths[ab] * corner(lengths[ab], lengths[ca], lengths[bc], 1).y;
    const double height = longest > 0 ? twice_area / longest : 0;
    for (const std::uint32_t point : s.triangles[t]) clear[point] = std::min(clear[point], height);
  }
  return clear;
}

bool are_far(double within, const Vector* a, std::size_t as, const Vector* b, std::size_t bs) {
  const auto beyond = [&](double Vector::*axis) {
    double low_a = a[0].*axis, high_a = low_a, low_b = b[0].*axis, high_b = low_b;
    for (std::size_t i = 1; i < as; ++i) {
      low_a = std::min(low_a, a[i].*axis);
      high_a = std::max(high_a, a[i].*axis);
    }
    for (std::size_t i = 1; i < bs; ++i) {
      low_b = std::min(low_b, b[i].*axis);
      high_b = std::max(high_b, b[i].*axis);
    }
    return low_a - high_b > within || low_b - high_a > within;
  };
  return beyond(&Vector::x) || beyond(&Vector::y);
}

/// Around one triangle, all in its plane.
class FlatPatch {
 public:
  FlatPatch(const TriangleSurface& surface, const std::vector<double>& lengths,
            const SewnPoints& sewn)
      : surface_(surface),
        lengths_(lengths),
        sewn_(sewn),
        seen_in_(surface.triangles.size(), kNoIndex) {}

  struct Laid {
    std::uint32_t triangle = 0;
    Corners corners{};
  };
  /// All that come nearer to the triangle than that.
  const std::vector<Laid>& lay_around(std::uint32_t triangle, double within) {
    laid_.clear();
    const auto [ab, bc, ca] = surface_.edges_of[triangle];
    const double l = lengths_[ab];
    laid_.push_back(
        {triangle, {Vector{}, Vector{l, 0, 0}, corner(l, lengths_[ca], lengths_[bc], 1)}});
    seen_in_[triangle] = triangle;
    std::size_t edges = 0, corners = 0;
    while (true) {
      for (; edges < laid_.size(); ++edges) {
        for (std::size_t k = 0; k < 3; ++k) lay_beside(edges, k, triangle, within);
      }
      if (sewn_.empty() || corners == laid_.size()) return laid_;
      for (std::size_t k = 0; k < 3; ++k) lay_at_seam(corners, k, triangle, within);
      ++corners;
    }
  }

 private:
  void lay_beside(std::size_t at, std::size_t k, std::uint32_t source, double within) {
    const std::uint32_t from = laid_[at].triangle;
    const TriangleSurface::Triangle& corners = surface_.triangles[from];
    const std::uint32_t p = corners[k], q = corners[(k + 1) % 3];
    const Vector a = laid_[at].corners[k], b = laid_[at].corners[(k + 1) % 3],
                 c = laid_[at].corners[(k + 2) % 3];
    for (const std::uint32_t next : sewn_.triangles_at(surface_, p)) {
      if (!surface_.is_face(next) || seen_in_[next] == source) continue;
      const std::size_t at_p = corner_at(next, p), at_q = corner_at(next, q);
      if (at_p == 3 || at_q == 3 || at_p == at_q) continue;
      take({next, lay(next, at_p, at_q, a, b, c)}, source, within);
    }
  }
  /// Triangles that a seam joins to a corner alone, and to no edge there, lie on its other side.
  void lay_at_seam(std::size_t at, std::size_t k, std::uint32_t source, double within) {
    const std::uint32_t p = surface_.triangles[laid_[at].triangle][k];
    const auto triangles = sewn_.triangles_at(surface_, p);
    if (triangles.size() == surface_.triangles_at[p].size()) return;
    const Vector x = laid_[at].corners[k];
    const Vector away = 2 * x - laid_[at].corners[(k + 1) % 3] - laid_[at].corners[(k + 2) % 3];
    const double l = length(away);
    const Vector along = l > 0 ? (1 / l) * away : Vector{1, 0, 0}, across{-along.y, along.x, 0};
    for (const std::uint32_t next : triangles) {
      if (!surface_.is_face(next) || seen_in_[next] == source) continue;
      const std::size_t i = corner_at(next, p), j = (i + 1) % 3, m = (i + 2) % 3;
      const TriangleSurface::Triangle& edges = surface_.edges_of[next];
      const double to_j = lengths_[edges[i]], to_m = lengths_[edges[m]];
      const Vector third = corner(to_j, to_m, lengths_[edges[j]], 1);
      const double half = 0.5 * std::atan2(third.y, third.x), c = std::cos(half),
                   s = std::sin(half);
      Corners corners;
      corners[i] = x;
      corners[j] = x + (c * to_j) * along - (s * to_j) * across;
      corners[m] = x + (c * to_m) * along + (s * to_m) * across;
      take({next, corners}, source, within);
    }
  }
  void take(const Laid& laid, std::uint32_t source, double within) {
    if (!is_within(laid.corners, within)) return;
    seen_in_[laid.triangle] = source;
    laid_.push_back(laid);
  }
  /// Where the triangle has the point, or one that is sewn to it; 3: nowhere.
  std::size_t corner_at(std::uint32_t triangle, std::uint32_t point) const {
    const auto is_it = [&](std::uint32_t corner) { return sewn_.is_one(corner, point); };
    const TriangleSurface::Triangle& corners = surface_.triangles[triangle];
    return static_cast<std::size_t>(std::ranges::find_if(corners, is_it) - corners.begin());
  }
  /// Its corners p and q are at a and b; on the side of them that c is not on.
  Corners lay(std::uint32_t triangle, std::size_t p, std::size_t q, Vector a, Vector b,
              Vector c) const {
    const std::size_t k = 3 - p - q;
    const double to_next = lengths_[surface_.edges_of[triangle][k]],
                 to_last = lengths_[surface_.edges_of[triangle][(k + 2) % 3]];
    const bool next_is_p = (k + 1) % 3 == p;
    const Vector u = b - a, v = c - a;
    const double l = length(u);
    const Vector along = l > 0 ? (1 / l) * u : Vector{1, 0, 0}, across{-along.y, along.x, 0};
    const Vector at = corner(l, next_is_p ? to_next : to_last, next_is_p ? to_last : to_next,
                             dot(across, v) > 0 ? -1 : 1);
    Corners corners;
    corners[p] = a;
    corners[q] = b;
    corners[k] = a + at.x * along + at.y * across;
    return corners;
  }
  bool is_within(const Corners& corners, double within) const {
    double least = std::numeric_limits<double>::infinity();
    const Corners& source = laid_.front().corners;
    if (have_common(corners, source)) return true;
    if (are_far(within, corners.data(), 3, source.data(), 3)) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto distance = [](const reference::Nearest& nearest) { return length(nearest.r); };
      least = std::min(
          {least,
           distance(reference::nearest_in_triangle(corners[i], source[0], source[1], source[2])),
           distance(
               reference::nearest_in_triangle(source[i], corners[0], corners[1], corners[2]))});
    }
    return least < within;
  }

  /// Most triangles that are near have a corner of the source, and there is no more to find out.
  static bool have_common(const Corners& one, const Corners& other) {
    return std::ranges::any_of(one, [&](Vector a) {
      return std::ranges::any_of(other, [&](Vector b) { return a.x == b.x && a.y == b.y; });
    });
  }

  const TriangleSurface& surface_;
  const std::vector<double>& lengths_;
  const SewnPoints& sewn_;
  std::vector<Laid> laid_;
  std::vector<std::uint32_t> seen_in_;  // per triangle: around which it was laid last
};

/// Ways along threads, and along edges of faces that they are tied to.
class WaysAlongEdges {
 public:
  WaysAlongEdges(const TriangleSurface& surface, const std::vector<double>& lengths,
                 const SewnPoints& sewn)
      : surface_(surface),
        lengths_(lengths),
        sewn_(sewn),
        least_(surface.triangles_at.size(), std::numeric_limits<double>::infinity()) {}

  struct Reached {
    double way = 0;  // m, the shortest
    std::uint32_t point = 0;
    auto operator<=>(const Reached&) const = default;
  };
  /// All points nearer than that along edges, from the nearest on.
  const std::vector<Reached>& from(std::uint32_t point, double within) {
    reached_.clear();
    waiting_.assign(1, {0, point});
    least_[point] = 0;
    seen_.assign(1, point);
    while (!waiting_.empty()) {
      std::ranges::pop_heap(waiting_, std::greater<>());
      const Reached here = waiting_.back();
      waiting_.pop_back();
      if (here.way > least_[here.point]) continue;
      reached_.push_back(here);
      for (const std::uint32_t t : sewn_.triangles_at(surface_, here.point)) go_on(t, here, within);
    }
    for (const std::uint32_t seen : seen_) least_[seen] = std::numeric_limits<double>::infinity();
    return reached_;
  }

 private:
  void go_on(std::uint32_t triangle, const Reached& here, double within) {
    const TriangleSurface::Triangle& corners = surface_.triangles[triangle];
    for (std::size_t k = 0; k < 3; ++k) {
      if (!sewn_.is_one(corners[k], here.point)) continue;
      reach({here.way, corners[k]}, within);
      const std::size_t last = (k + 2) % 3, next = (k + 1) % 3;
      reach({here.way + lengths_[surface_.edges_of[triangle][k]], corners[next]}, within);
      reach({here.way + lengths_[surface_.edges_of[triangle][last]], corners[last]}, within);
    }
  }
  void reach(const Reached& there, double within) {
    if (!(there.way < within) || !(there.way < least_[there.point])) return;
    least_[there.point] = there.way;
    seen_.push_back(there.point);
    waiting_.push_back(there);
    std::ranges::push_heap(waiting_, std::greater<>());
  }

  const TriangleSurface& surface_;
  const std::vector<double>& lengths_;
  const SewnPoints& sewn_;
  std::vector<double> least_;  // m, per point
  std::vector<std::uint32_t> seen_;
  std::vector<Reached> waiting_, reached_;
};

/// Pairs of threads and of what they are tied to. They are as far apart as the way from one to the
/// other is long. A pair may come more than once.
template <class Take>
class PairsAlongThreads {
 public:
  /// take(kind, first, second, distance)
  PairsAlongThreads(const TriangleSurface& surface, const SewnPoints& sewn, Take& take)
      : surface_(surface), sewn_(sewn), take_(take) {}

  void find(WaysAlongEdges& ways, double within) {
    for (std::uint32_t point = 0; point < surface_.triangles_at.size(); ++point) {
      threads_.clear();
      std::ranges::copy_if(surface_.triangles_at[point], std::back_inserter(threads_),
                           [&](std::uint32_t t) { return surface_.is_thread(t); });
      if (threads_.empty()) continue;
      for (const auto& [way, other] : ways.from(point, within)) {
        if (!sewn_.is_one(other, point)) add(point, other, way);
      }
    }
  }

 private:
  bool has(std::span<const std::uint32_t> corners, std::uint32_t point) const {
    return std::ranges::any_of(corners, [&](std::uint32_t c) { return sewn_.is_one(c, point); });
  }
  /// Adds the threads at a point, and the features at another one.
  void add(std::uint32_t point, std::uint32_t other, double way) const {
    for (const std::uint32_t t : threads_) {
      if (!has(surface_.triangles[t], other)) take_(PairKind::point_triangle, other, t, way);
    }
    for (const std::uint32_t t : surface_.triangles_at[other]) {
      if (!has(surface_.triangles[t], point)) take_(PairKind::point_triangle, point, t, way);
      for (const std::uint32_t edge : surface_.edges_of[t]) {
        if (has(surface_.edges[edge], other)) add_edge(edge, way);
      }
    }
  }
  void add_edge(std::uint32_t edge, double way) const {
    for (const std::uint32_t t : threads_) {
      const std::uint32_t thread = surface_.edges_of[t][0];
      const auto [a, b] = surface_.edges[thread];
      const auto& ends = surface_.edges[edge];
      if (!has(ends, a) && !has(ends, b)) take_(PairKind::edges, thread, edge, way);
    }
  }

  const TriangleSurface& surface_;
  const SewnPoints& sewn_;
  Take& take_;
  std::vector<std::uint32_t> threads_;  // at the point
};

}  // namespace

std::uint64_t RestDistances::key_of(PairKind kind, std::uint32_t first, std::uint32_t second) {
  const bool edges = kind == PairKind::edges;
  if (edges && second < first) std::swap(first, second);
  return std::uint64_t{first} << 33 | std::uint64_t{second} << 1 | (edges ? 1u : 0u);
}

RestDistances::RestDistances(const Model& model, double thickness, const SewnPoints& sewn)
    : thickness_(thickness) {
  const TriangleSurface& s = model.touched_surface();
  const std::vector<double> lengths = lengths_at_rest(model, s);
  const std::vector<double> clear = clear_around_points(s, lengths, sewn);
  FlatPatch patch(s, lengths, sewn);
  const auto take = [&](PairKind kind, std::uint32_t first, std::uint32_t second, double distance) {
    if (distance < thickness)
      nearer_.push_back({key_of(kind, first, second), tuning::kRestDistance * distance});
  };
  const auto has_corner = [&](const TriangleSurface::Triangle& triangle, std::uint32_t point) {
    return std::ranges::any_of(triangle,
                               [&](std::uint32_t corner) { return sewn.is_one(corner, point); });
  };
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    if (!s.is_face(t)) continue;
    const TriangleSurface::Triangle& corners = s.triangles[t];
    if (std::ranges::all_of(corners, [&](std::uint32_t p) { return clear[p] > thickness; }))
      continue;
    const auto& laid = patch.lay_around(t, thickness);
    const Corners here = laid.front().corners;
    for (const auto& [other, there] : laid) {
      const TriangleSurface::Triangle& its = s.triangles[other];
      for (std::size_t k = 0; k < 3; ++k) {
        if (has_corner(corners, its[k])) continue;
        if (are_far(thickness, &there[k], 1, here.data(), 3)) continue;
        take(PairKind::point_triangle, its[k], t,
             length(reference::nearest_in_triangle(there[k], here[0], here[1], here[2]).r));
      }
      if (other <= t) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          const std::array mine{here[i], here[(i + 1) % 3]}, theirs{there[j], there[(j + 1) % 3]};
          const auto [a, b] = s.edges[s.edges_of[t][i]];
          const auto [c, d] = s.edges[s.edges_of[other][j]];
          if (sewn.is_one(a, c) || sewn.is_one(a, d) || sewn.is_one(b, c) || sewn.is_one(b, d))
            continue;
          if (are_far(thickness, mine.data(), 2, theirs.data(), 2)) continue;
          take(PairKind::edges, s.edges_of[t][i], s.edges_of[other][j],
               length(reference::nearest_of_edges(mine[0], mine[1], theirs[0], theirs[1]).r));
        }
      }
    }
  }
  if (s.has_threads) {
    WaysAlongEdges ways(s, lengths, sewn);
    PairsAlongThreads(s, sewn, take).find(ways, thickness);
  }
  std::ranges::sort(nearer_, [](const Nearer& a, const Nearer& b) {
    return std::pair(a.key, a.distance) < std::pair(b.key, b.distance);
  });
  erase_repeated(nearer_, &Nearer::key);
  nearer_.shrink_to_fit();
}

double RestDistances::of(const Pair& pair) const {
  if (nearer_.empty()) return thickness_;
  const std::uint64_t key = key_of(pair.kind, pair.first, pair.second);
  const auto found = std::ranges::lower_bound(nearer_, key, {}, &Nearer::key);
  return found != nearer_.end() && found->key == key ? found->distance : thickness_;
}

}  // namespace weft
