#include "engine/surface/tears.h"

#include <algorithm>
#include <compare>
#include <limits>
#include <queue>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/erase_repeated.h"
#include "engine/geometry.h"
#include "engine/lists.h"
#include "engine/surface/nearest_triangle.h"
#include "kernels/reference/distances.h"

namespace weft::surface {

std::vector<Triangle> corners_now(const DrawnMesh& drawn, std::span<const Triangle> before,
                                  std::span<const Triangle> now) {
  std::vector<Triangle> corners(drawn.triangles.size());
  for (std::size_t t = 0; t < corners.size(); ++t) {
    const Triangle& part = before[drawn.part[t]];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t particle = drawn.vertices[drawn.triangles[t][k]].point;
      const auto at = std::ranges::find(part, particle) - part.begin();
      corners[t][k] = now[drawn.part[t]][static_cast<std::size_t>(at)];
    }
  }
  return corners;
}

// ------------------------------------------------------------------------------------ drawn meshes

namespace {

/// The points of a quad, if both of its triangles have the same at the corners of both.
bool find_quad(const std::array<std::uint32_t, 4>& before, const Triangle* of_before,
               const Triangle* corners, std::array<std::uint32_t, 4>& quad) {
  for (std::size_t i = 0; i < 4; ++i) {
    quad[i] = kNoIndex;
    for (std::size_t t = 0; t < 2; ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (of_before[t][k] != before[i]) continue;
        if (quad[i] != kNoIndex && quad[i] != corners[t][k]) return false;
        quad[i] = corners[t][k];
      }
    }
  }
  return true;
}

PointFaces torn_faces(const DrawnMesh& drawn, std::span<const Triangle> corners) {
  PointFaces faces;
  for (const std::uint32_t t : drawn.of_triangles) faces.triangles.push_back(corners[t]);
  for (std::size_t q = 0; q < drawn.faces.quads.size(); ++q) {
    const std::uint32_t first = drawn.of_quads[q];
    std::array<Triangle, 2> before{};
    for (std::size_t t = 0; t < 2; ++t) {
      for (std::size_t k = 0; k < 3; ++k)
        before[t][k] = drawn.vertices[drawn.triangles[first + t][k]].point;
    }
    std::array<std::uint32_t, 4> quad{};
    if (find_quad(drawn.faces.quads[q], before.data(), &corners[first], quad))
      faces.quads.push_back(quad);
    else
      faces.triangles.insert(faces.triangles.end(), {corners[first], corners[first + 1]});
  }
  return faces;
}

}  // namespace

TornMesh torn_mesh(const DrawnMesh& drawn, std::span<const Triangle> corners) {
  using Split = std::pair<std::uint32_t, std::uint32_t>;  // a point, and a vertex that has another
  std::vector<Split> splits;
  const auto for_each_split = [&](auto&& work) {
    for (std::size_t t = 0; t < corners.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = drawn.triangles[t][k];
        if (corners[t][k] != drawn.vertices[vertex].point) work(t, k, Split{corners[t][k], vertex});
      }
    }
  };
  for_each_split([&](std::size_t, std::size_t, const Split& split) { splits.push_back(split); });
  std::ranges::sort(splits);
  erase_repeated(splits);
  TornMesh torn;
  torn.drawn.vertices = drawn.vertices;
  torn.drawn.triangles = drawn.triangles;
  for (const auto& [point, vertex] : splits) {
    torn.split_from.push_back(vertex);
    torn.drawn.vertices.push_back({point, drawn.vertices[vertex].side});
  }
  for_each_split([&](std::size_t t, std::size_t k, const Split& split) {
    const auto at = std::ranges::lower_bound(splits, split) - splits.begin();
    torn.drawn.triangles[t][k] =
        static_cast<std::uint32_t>(drawn.vertices.size() + static_cast<std::size_t>(at));
  });
  torn.drawn.faces = torn_faces(drawn, corners);
  return torn;
}

// ----------------------------------------------------------------------------------- mapped meshes

namespace {

using mesh::operator+;
using mesh::operator-;
using mesh::operator*;

/// Places nearer than this share of an edge are at it.
constexpr double kAtEdge = 1e-9;

/// The triangles of a cloth around its tears, and how they hang together.
class TornPlace {
 public:
  TornPlace(const MappedStart& start, std::span<const Triangle> now)
      : start_(start), now_(now), is_torn_(start.particles.size()), local_(now.size(), kNoIndex) {
    for (std::size_t t = 0; t < now.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k)
        if (now[t][k] != start.triangles[t][k]) is_torn_[start.triangles[t][k]] = true;
    }
    const std::vector<bool> near = touched_by(is_torn_);
    std::vector<bool> particles(start.particles.size());
    for (std::size_t t = 0; t < now.size(); ++t) {
      if (!near[t]) continue;
      is_near_.push_back(static_cast<std::uint32_t>(t));
      for (const std::uint32_t corner : start.triangles[t]) particles[corner] = true;
    }
    const std::vector<bool> around = touched_by(particles);
    for (std::uint32_t t = 0; t < now.size(); ++t)
      if (around[t]) take(t);
    std::ranges::sort(edges_);
  }

  bool is_near(std::uint32_t triangle) const {
    return std::ranges::binary_search(is_near_, triangle);
  }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<std::uint32_t>& numbers() const { return numbers_; }

  /// The last triangle on the way from one to another that no tear is before; kNoIndex: there is
  /// no tear on the way. The way follows the straight line from a to b.
  std::uint32_t before_tear(std::uint32_t from, std::uint32_t to, Vec3 a, Vec3 b) const {
    if (local_[from] == kNoIndex || local_[to] == kNoIndex) return kNoIndex;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> waiting;
    std::vector<std::uint32_t> before(triangles_.size(), kNoIndex);
    waiting.push({0, 0, from, from});
    while (!waiting.empty()) {
      const Reached at = waiting.top();
      waiting.pop();
      if (before[local_[at.triangle]] != kNoIndex) continue;
      before[local_[at.triangle]] = at.from;
      if (at.triangle == to) return first_tear(from, to, before);
      for_each_neighbour(at.triangle, [&](std::uint32_t next, const Edge& edge) {
        if (before[local_[next]] != kNoIndex) return;
        waiting.push({at.beside + distance(edge, a, b), at.hops + 1, next, at.triangle});
      });
    }
    return kNoIndex;
  }
  /// Whether both have a particle of a torn place.
  bool share_torn(std::uint32_t one, std::uint32_t other) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!is_torn_[start_.triangles[one][k]]) continue;
      if (std::ranges::find(now_[other], now_[one][k]) != now_[other].end()) return true;
    }
    return false;
  }

 private:
  /// A triangle on a way, and the one that the way comes from. Ways are ordered by what they leave
  /// the straight line, and then by their triangles.
  struct Reached {
    double beside;
    int hops;
    std::uint32_t triangle, from;
    auto operator<=>(const Reached&) const = default;
  };
  struct Edge {
    std::uint32_t p = 0, q = 0, triangle = 0;
    auto operator<=>(const Edge&) const = default;
  };

  std::vector<bool> touched_by(const std::vector<bool>& particles) const {
    std::vector<bool> touched(now_.size());
    for (std::size_t t = 0; t < touched.size(); ++t) {
      touched[t] = std::ranges::any_of(start_.triangles[t],
                                       [&](std::uint32_t corner) { return particles[corner]; });
    }
    return touched;
  }
  void take(std::uint32_t t) {
    local_[t] = static_cast<std::uint32_t>(numbers_.size());
    numbers_.push_back(t);
    triangles_.push_back(start_.triangles[t]);
    for (std::size_t k = 0; k < 3; ++k) edges_.push_back(edge(t, k));
  }
  Edge edge(std::uint32_t t, std::size_t k) const {
    const auto [p, q] = std::minmax(start_.triangles[t][k], start_.triangles[t][(k + 1) % 3]);
    return {p, q, t};
  }
  template <class Work>
  void for_each_neighbour(std::uint32_t t, Work&& work) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge its = edge(t, k);
      auto other = std::ranges::lower_bound(edges_, Edge{its.p, its.q, 0});
      for (; other != edges_.end() && other->p == its.p && other->q == its.q; ++other)
        if (other->triangle != t) work(other->triangle, its);
    }
  }
  /// m, between the edge and the line.
  double distance(const Edge& edge, Vec3 a, Vec3 b) const {
    const auto vector = [](Vec3 v) { return kernels::Vector{v.x, v.y, v.z}; };
    const Vec3 p = start_.particles[edge.p], q = start_.particles[edge.q];
    const double found =
        kernels::length(reference::nearest_of_edges(vector(a), vector(b), vector(p), vector(q)).r);
    return found > kAtEdge * mesh::length(q - p) ? found : 0;
  }
  std::uint32_t image(std::uint32_t triangle, std::uint32_t particle) const {
    const Triangle& corners = start_.triangles[triangle];
    return now_[triangle]
               [static_cast<std::size_t>(std::ranges::find(corners, particle) - corners.begin())];
  }
  bool are_apart(std::uint32_t one, std::uint32_t other) const {
    bool apart = true;
    for_each_neighbour(one, [&](std::uint32_t next, const Edge& edge) {
      if (next == other && image(one, edge.p) == image(other, edge.p) &&
          image(one, edge.q) == image(other, edge.q))
        apart = false;
    });
    return apart;
  }
  std::uint32_t first_tear(std::uint32_t from, std::uint32_t to,
                           const std::vector<std::uint32_t>& before) const {
    std::uint32_t found = kNoIndex;
    for (std::uint32_t here = to; here != from; here = before[local_[here]])
      if (are_apart(before[local_[here]], here)) found = before[local_[here]];
    return found;
  }

  const MappedStart& start_;
  std::span<const Triangle> now_;
  std::vector<bool> is_torn_;           // per particle: it was split
  std::vector<std::uint32_t> is_near_;  // triangles at such a particle, in order
  std::vector<std::uint32_t> local_;    // per triangle: its place in the lists below
  std::vector<std::uint32_t> numbers_;  // triangles beside those
  std::vector<Triangle> triangles_;
  std::vector<Edge> edges_;  // in order
};

/// Adds points that follow the other side of a tear.
class Sides {
 public:
  Sides(const MappedStart& start, std::span<const Triangle> now, const DrawnMesh& drawn,
        std::span<const Following> points)
      : start_(start), now_(now), drawn_(drawn), place_(start, now) {
    torn_.points.assign(points.begin(), points.end());
    for (std::size_t i = 0; i < points.size(); ++i)
      torn_.points[i].corners = now[start.triangle_of[i]];
    torn_.corners = point_triangles(drawn);
  }

  TornPoints run() {
    const NearestTriangle nearest(start_.particles, place_.triangles());
    if (nearest.is_empty()) return std::move(torn_);
    std::vector<bool> is_second(torn_.corners.size());
    for (const std::uint32_t t : drawn_.of_quads) is_second[t + 1] = true;
    for (std::size_t t = 0; t < torn_.corners.size(); ++t) {
      if (is_second[t] || !is_near(t)) continue;
      look_at(t, t + 1 < is_second.size() && is_second[t + 1] ? 2 : 1, nearest);
    }
    std::ranges::stable_sort(moved_, {}, &Moved::point);
    for (std::size_t i = 0; i < moved_.size();) i = add_sides(i);
    return std::move(torn_);
  }

 private:
  /// A corner of a triangle whose middle is on the other side of a tear.
  struct Moved {
    std::uint32_t point = 0;
    std::uint32_t beside = 0;  // a triangle of the cloth, on the side of the middle
    std::size_t triangle = 0, corner = 0;
  };

  bool is_near(std::size_t t) const {
    return std::ranges::any_of(torn_.corners[t], [&](std::uint32_t point) {
      return place_.is_near(start_.triangle_of[point]);
    });
  }
  /// A face, of one triangle or two.
  void look_at(std::size_t first, std::size_t count, const NearestTriangle& nearest) {
    Vec3 middle;
    for (std::size_t t = first; t < first + count; ++t) {
      for (const std::uint32_t point : torn_.corners[t])
        middle = middle + 1 / (3. * static_cast<double>(count)) * start_.points[point];
    }
    const std::uint32_t at = place_.numbers()[nearest(middle).triangle];
    for (std::size_t t = first; t < first + count; ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t point = torn_.corners[t][k];
        const std::uint32_t beside =
            place_.before_tear(at, start_.triangle_of[point], middle, start_.points[point]);
        if (beside != kNoIndex) moved_.push_back({point, beside, t, k});
      }
    }
  }
  /// All of one point. Returns the end of these.
  std::size_t add_sides(std::size_t begin) {
    std::size_t end = begin;
    while (end < moved_.size() && moved_[end].point == moved_[begin].point) ++end;
    std::vector<bool> is_done(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      if (is_done[i - begin]) continue;
      std::vector<std::size_t> side{i};
      is_done[i - begin] = true;
      for (std::size_t n = 0; n < side.size(); ++n) {
        for (std::size_t j = begin; j < end; ++j) {
          if (is_done[j - begin] || !are_on_one_side(side[n], j)) continue;
          is_done[j - begin] = true;
          side.push_back(j);
        }
      }
      add_point(side);
    }
    return end;
  }
  bool are_on_one_side(std::size_t i, std::size_t j) const {
    return moved_[i].beside == moved_[j].beside ||
           place_.share_torn(moved_[i].beside, moved_[j].beside);
  }
  void add_point(const std::vector<std::size_t>& side) {
    std::vector<std::uint32_t> numbers;
    for (const std::size_t i : side) numbers.push_back(moved_[i].beside);
    std::ranges::sort(numbers);
    erase_repeated(numbers);
    std::vector<Triangle> triangles;
    for (const std::uint32_t t : numbers) triangles.push_back(start_.triangles[t]);
    const Vec3 at = start_.points[moved_[side[0]].point];
    const Nearest nearest = NearestTriangle(start_.particles, triangles)(at);
    if (nearest.triangle == kNoIndex) return;  // none has an area
    Following point =
        following(at, triangles[nearest.triangle], nearest, start_.particles, start_.normals);
    point.corners = now_[numbers[nearest.triangle]];
    for (const std::size_t i : side)
      torn_.corners[moved_[i].triangle][moved_[i].corner] =
          static_cast<std::uint32_t>(torn_.points.size());
    torn_.points.push_back(point);
  }

  const MappedStart& start_;
  std::span<const Triangle> now_;
  const DrawnMesh& drawn_;
  TornPlace place_;
  TornPoints torn_;
  std::vector<Moved> moved_;
};

}  // namespace

std::size_t MappedStart::bytes() const {
  return bytes_of(triangles) + bytes_of(particles) + bytes_of(normals) + bytes_of(points) +
         bytes_of(triangle_of);
}

TornPoints torn_points(const MappedStart& start, std::span<const Triangle> triangles,
                       const DrawnMesh& drawn, std::span<const Following> points) {
  return Sides(start, triangles, drawn, points).run();
}

}  // namespace weft::surface
