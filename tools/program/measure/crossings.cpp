#include "tools/program/measure/crossings.h"

#include <algorithm>
#include <numeric>
#include <variant>

#include "tools/program/measure/side_of_plane.h"
#include "tools/scenes/body_moves.h"

namespace weft::tools {
namespace {

using Coordinate = double Vec3::*;
constexpr std::array<Coordinate, 3> kAxes{&Vec3::x, &Vec3::y, &Vec3::z};

struct Box {
  Vec3 low, high;
  bool meets(const Box& other) const {
    return std::ranges::all_of(kAxes, [&](Coordinate axis) {
      return low.*axis <= other.high.*axis && high.*axis >= other.low.*axis;
    });
  }
  void add(const Box& other) {
    for (const Coordinate axis : kAxes) {
      low.*axis = std::min(low.*axis, other.low.*axis);
      high.*axis = std::max(high.*axis, other.high.*axis);
    }
  }
  double extent(Coordinate axis) const { return high.*axis - low.*axis; }
};

using Numbers = std::vector<std::uint32_t>;

Box box_of(const std::vector<Box>& boxes, const Numbers& some) {
  Box sum = boxes[some.front()];
  for (const std::uint32_t i : some) sum.add(boxes[i]);
  return sum;
}

/// Halves the larger of two lists of boxes, and keeps of the other what meets each half.
class Divider {
 public:
  Divider(const TriangleSet& a, const TriangleSet& b, double reach)
      : boxes_{boxes(a, reach), boxes(b, 0)} {}

  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs() {
    std::array<Numbers, 2> all;
    for (std::size_t side = 0; side < 2; ++side) {
      all[side].resize(boxes_[side].size());
      std::iota(all[side].begin(), all[side].end(), 0u);
    }
    divide(std::move(all[0]), std::move(all[1]));
    return std::move(pairs_);
  }

 private:
  static std::vector<Box> boxes(const TriangleSet& set, double reach) {
    std::vector<Box> boxes;
    for (const auto& [a, b, c] : set.triangles) {
      Box box{set.places[a], set.places[a]};
      for (const std::uint32_t corner : {b, c}) box.add({set.places[corner], set.places[corner]});
      for (const Coordinate axis : kAxes) {
        box.low.*axis -= reach;
        box.high.*axis += reach;
      }
      boxes.push_back(box);
    }
    return boxes;
  }

  void divide(Numbers a, Numbers b) {
    constexpr std::size_t kFew = 16;
    if (a.empty() || b.empty()) return;
    if (a.size() <= kFew && b.size() <= kFew) return compare(a, b);
    const bool halves_a = a.size() >= b.size();
    Numbers& larger = halves_a ? a : b;
    const std::vector<Box>& boxes = boxes_[halves_a ? 0 : 1];
    const Box all = box_of(boxes, larger);
    keep(halves_a ? b : a, boxes_[halves_a ? 1 : 0], all);
    const Coordinate axis = *std::ranges::max_element(
        kAxes, {}, [&](Coordinate candidate) { return all.extent(candidate); });
    const auto middle = larger.begin() + static_cast<std::ptrdiff_t>(larger.size() / 2);
    std::ranges::nth_element(larger, middle, {}, [&](std::uint32_t i) {
      return boxes[i].low.*axis + boxes[i].high.*axis;
    });
    Numbers rest(middle, larger.end());
    larger.erase(middle, larger.end());
    if (halves_a) {
      divide(std::move(a), b);
      divide(std::move(rest), std::move(b));
    } else {
      divide(a, std::move(b));
      divide(std::move(a), std::move(rest));
    }
  }

  static void keep(Numbers& some, const std::vector<Box>& boxes, const Box& box) {
    std::erase_if(some, [&](std::uint32_t i) { return !boxes[i].meets(box); });
  }

  void compare(const Numbers& a, const Numbers& b) {
    for (const std::uint32_t i : a) {
      for (const std::uint32_t j : b) {
        if (boxes_[0][i].meets(boxes_[1][j])) pairs_.emplace_back(i, j);
      }
    }
  }

  std::array<std::vector<Box>, 2> boxes_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
};

using Corners = std::array<Vec3, 3>;

Corners corners_of(const TriangleSet& set, std::uint32_t triangle) {
  const auto& [a, b, c] = set.triangles[triangle];
  return {set.places[a], set.places[b], set.places[c]};
}

/// Also where it leads through an edge or a corner of the triangle.
bool leads_through(Vec3 from, Vec3 to, const Corners& t) {
  if (side_of_plane(t[0], t[1], t[2], from) * side_of_plane(t[0], t[1], t[2], to) >= 0)
    return false;
  int least = 0, most = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const int turn = side_of_plane(from, to, t[k], t[(k + 1) % 3]);
    least = std::min(least, turn);
    most = std::max(most, turn);
  }
  return least == 0 || most == 0;
}

bool an_edge_leads_through(const Corners& edges, const Corners& triangle) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (leads_through(edges[k], edges[(k + 1) % 3], triangle)) return true;
  }
  return false;
}

}  // namespace

TriangleSet meshes_at(std::span<const SceneBody> bodies, double time) {
  TriangleSet set;
  for (const SceneBody& body : bodies) {
    const auto* mesh = std::get_if<TriangleMesh>(&body.shape);
    if (!mesh) continue;
    const auto first = static_cast<std::uint32_t>(set.places.size());
    const std::vector<Vec3> places = places_at(body, time);
    set.places.insert(set.places.end(), places.begin(), places.end());
    for (const auto& [a, b, c] : mesh->triangles)
      set.triangles.push_back({first + a, first + b, first + c});
  }
  return set;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> near_pairs(const TriangleSet& a,
                                                                const TriangleSet& b,
                                                                double reach) {
  return Divider(a, b, reach).pairs();
}

namespace {

/// Edges that end in a corner of a triangle are on no side of it: neighbours do not cross there.
bool cross(const Corners& one, const Corners& other) {
  return an_edge_leads_through(one, other) || an_edge_leads_through(other, one);
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> crossings(const TriangleSet& a,
                                                               const TriangleSet& b) {
  auto pairs = near_pairs(a, b, 0);
  std::erase_if(pairs, [&](const auto& pair) {
    return !cross(corners_of(a, pair.first), corners_of(b, pair.second));
  });
  return pairs;
}

}  // namespace

std::size_t count_crossings(const TriangleSet& a, const TriangleSet& b) {
  return crossings(a, b).size();
}

std::size_t count_crossings(const TriangleSet& surface) {
  const auto crosses = [&](const auto& pair) {
    return pair.first < pair.second && do_cross(surface, pair.first, pair.second);
  };
  return static_cast<std::size_t>(std::ranges::count_if(near_pairs(surface, surface, 0), crosses));
}

bool do_cross(const TriangleSet& surface, std::uint32_t one, std::uint32_t other) {
  return cross(corners_of(surface, one), corners_of(surface, other));
}

NamedCrossing name_crossing(const TriangleSet& cloth, std::span<const SceneBody> bodies,
                            double time) {
  NamedCrossing named;
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    const auto pairs = crossings(cloth, meshes_at(bodies.subspan(body, 1), time));
    if (pairs.empty()) continue;
    if (named.count == 0) {
      named.body = body;
      named.triangle = std::ranges::min(pairs).first;
      const auto [a, b, c] = corners_of(cloth, named.triangle);
      named.place = {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, (a.z + b.z + c.z) / 3};
    }
    named.count += pairs.size();
  }
  return named;
}

}  // namespace weft::tools
