#include "perf/layers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <unordered_map>
#include <utility>

#include "engine/erase_repeated.h"
#include "kernels/reference/distances.h"

namespace weft::perf {

using kernels::Vector;

namespace {

constexpr int kSheets = 5;
constexpr double kCell = 0.02;         // m
constexpr double kMargin = kCell / 4;  // m, of candidates
constexpr double kNear = 1.3;          // thicknesses
constexpr double kLean = 0.6;          // a sine: what leans more is a neighbour's
constexpr double kParticleMass = 0.15 * kCell * kCell;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// On the level; sheets lie on each other everywhere.
struct Rectangle {
  double low[2] = {std::numeric_limits<double>::infinity(),
                   std::numeric_limits<double>::infinity()};
  double high[2] = {-std::numeric_limits<double>::infinity(),
                    -std::numeric_limits<double>::infinity()};

  void add(Vector x) {
    low[0] = std::min(low[0], x.x), high[0] = std::max(high[0], x.x);
    low[1] = std::min(low[1], x.z), high[1] = std::max(high[1], x.z);
  }
  bool meets(const Rectangle& other) const {
    return low[0] - kMargin <= other.high[0] && other.low[0] - kMargin <= high[0] &&
           low[1] - kMargin <= other.high[1] && other.low[1] - kMargin <= high[1];
  }
};

/// Features by the squares of the level that their rectangles meet.
class Squares {
 public:
  void add(std::uint32_t feature, const Rectangle& rectangle) {
    rectangles_.push_back(rectangle);
    for_each_square(rectangle, 0, [&](std::uint64_t square) { of_[square].push_back(feature); });
  }
  /// visit(feature) once, of those that meet it.
  template <class Visit>
  void for_each_meeting(const Rectangle& rectangle, Visit&& visit) {
    met_.clear();
    for_each_square(rectangle, kMargin, [&](std::uint64_t square) {
      const auto found = of_.find(square);
      if (found != of_.end()) met_.insert(met_.end(), found->second.begin(), found->second.end());
    });
    std::ranges::sort(met_);
    erase_repeated(met_);
    for (const std::uint32_t feature : met_)
      if (rectangles_[feature].meets(rectangle)) visit(feature);
  }

 private:
  template <class Visit>
  static void for_each_square(const Rectangle& r, double margin, Visit&& visit) {
    const auto at = [](double x) { return static_cast<std::int32_t>(std::floor(x / kCell)); };
    for (std::int32_t i = at(r.low[0] - margin); i <= at(r.high[0] + margin); ++i)
      for (std::int32_t j = at(r.low[1] - margin); j <= at(r.high[1] + margin); ++j)
        visit(std::uint64_t{static_cast<std::uint32_t>(i)} << 32 | static_cast<std::uint32_t>(j));
  }

  std::vector<Rectangle> rectangles_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> of_;
  std::vector<std::uint32_t> met_;
};

struct Sheet {
  struct Edge {
    std::uint32_t ends[2];
    std::uint32_t opposite[2] = {kNone, kNone};  // third corners of its faces
  };
  std::uint32_t first = 0, last = 0;  // points
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Edge> edges;
  std::unordered_map<std::uint64_t, std::size_t> edge_of;

  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
  }
  void add(std::array<std::uint32_t, 3> triangle) {
    triangles.push_back(triangle);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
      const auto [found, is_new] = edge_of.emplace(key(a, b), edges.size());
      if (is_new) edges.push_back({{a, b}});
      Edge& edge = edges[found->second];
      edge.opposite[edge.opposite[0] == kNone ? 0 : 1] = triangle[(k + 2) % 3];
    }
  }
  LayerPair pair(std::uint32_t point, const std::array<std::uint32_t, 3>& triangle) const {
    LayerPair pair{.points = {point, triangle[0], triangle[1], triangle[2]}};
    pair.beside[3] = triangle[0];
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge& side = edges[edge_of.at(key(triangle[k], triangle[(k + 1) % 3]))];
      const std::uint32_t own = triangle[(k + 2) % 3];
      const std::uint32_t other = side.opposite[side.opposite[0] == own ? 1 : 0];
      pair.is_border[k] = other == kNone;
      pair.beside[k] = other == kNone ? own : other;
    }
    return pair;
  }
  static LayerPair pair(const Edge& first, const Edge& second) {
    LayerPair pair{.edges = true,
                   .points = {first.ends[0], first.ends[1], second.ends[0], second.ends[1]}};
    const Edge* const of[] = {&first, &second};
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t third = of[k / 2]->opposite[k % 2];
      pair.beside[k] = third == kNone ? of[k / 2]->ends[0] : third;
    }
    return pair;
  }
};

class Builder {
 public:
  explicit Builder(int size) {
    for (int layer = 0; layer < kSheets; ++layer) add_sheet(size, layer);
    for (std::size_t k = 0; k + 1 < sheets_.size(); ++k) find(sheets_[k], sheets_[k + 1]);
  }
  Layers layers;

 private:
  void add_sheet(int size, int layer);
  void find(const Sheet& below, const Sheet& above);
  void add(const LayerPair& pair);

  std::vector<Sheet> sheets_;
};

void Builder::add_sheet(int size, int layer) {
  Sheet& sheet = sheets_.emplace_back();
  sheet.first = static_cast<std::uint32_t>(layers.points.size());
  const double middle = 0.5 * kCell * (size - 1), turn = 0.1 * layer;
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) {
      const double x = kCell * i - middle, z = kCell * j - middle;
      const double wave = std::sin(37 * x + layer) * std::sin(53 * z + 2 * layer);
      layers.points.push_back({std::cos(turn) * x - std::sin(turn) * z,
                               kLayerThickness * (layer + 0.1 * wave),
                               std::sin(turn) * x + std::cos(turn) * z});
      layers.inverse_mass.push_back(layer == 0 ? 0 : 1 / kParticleMass);
    }
  }
  sheet.last = static_cast<std::uint32_t>(layers.points.size());
  const auto n = static_cast<std::uint32_t>(size);
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    for (std::uint32_t j = 0; j + 1 < n; ++j) {
      const std::uint32_t at = sheet.first + i * n + j;
      sheet.add({at, at + 1, at + n + 1});
      sheet.add({at, at + n + 1, at + n});
    }
  }
}

void Builder::find(const Sheet& below, const Sheet& above) {
  const auto around = [&](const auto& corners) {
    Rectangle rectangle;
    for (const std::uint32_t corner : corners) rectangle.add(layers.points[corner]);
    return rectangle;
  };
  for (const auto& [of_points, of_triangles] :
       {std::pair{&above, &below}, std::pair{&below, &above}}) {
    Squares squares;
    for (std::uint32_t t = 0; t < of_triangles->triangles.size(); ++t)
      squares.add(t, around(of_triangles->triangles[t]));
    for (std::uint32_t point = of_points->first; point < of_points->last; ++point) {
      squares.for_each_meeting(around(std::array{point}), [&](std::uint32_t t) {
        add(of_triangles->pair(point, of_triangles->triangles[t]));
      });
    }
  }
  Squares squares;
  for (std::uint32_t e = 0; e < below.edges.size(); ++e)
    squares.add(e, around(below.edges[e].ends));
  for (const Sheet::Edge& edge : above.edges) {
    squares.for_each_meeting(around(edge.ends),
                             [&](std::uint32_t e) { add(Sheet::pair(edge, below.edges[e])); });
  }
}

void Builder::add(const LayerPair& pair) {
  layers.candidates.push_back(pair);
  const Vector a = layers.points[pair.points[0]], b = layers.points[pair.points[1]],
               c = layers.points[pair.points[2]], d = layers.points[pair.points[3]];
  const reference::Nearest nearest = pair.edges ? reference::nearest_of_edges(a, b, c, d)
                                                : reference::nearest_in_triangle(a, b, c, d);
  const double distance = layers.candidates.back().distance = length(nearest.r);
  const bool leans = std::hypot(nearest.r.x, nearest.r.z) > kLean * distance;
  if (distance < kNear * kLayerThickness && !leans) layers.near.push_back(layers.candidates.back());
}

}  // namespace

Layers make_layers(int size) { return std::move(Builder(size).layers); }

}  // namespace weft::perf
