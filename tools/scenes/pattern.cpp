#include "tools/scenes/pattern.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace weft::scenes {
namespace {

constexpr int kParts = 256;  // of a curve whose length is measured

/// A curve by its length.
class Ruled {
 public:
  explicit Ruled(const Curve& curve) {
    for (int i = 0; i <= kParts; ++i) {
      const Point p = curve(static_cast<double>(i) / kParts);
      const double step = i > 0 ? std::hypot(p.x - points_.back().x, p.y - points_.back().y) : 0;
      lengths_.push_back(i > 0 ? lengths_.back() + step : 0);
      points_.push_back(p);
    }
  }
  double length() const { return lengths_.back(); }
  Point at(double share) const {
    const double along = share * length();
    const auto next = std::ranges::upper_bound(lengths_, along);
    if (next == lengths_.end()) return points_.back();
    const auto k = static_cast<std::size_t>(next - lengths_.begin());
    const double rest = (along - lengths_[k - 1]) / (lengths_[k] - lengths_[k - 1]);
    const Point a = points_[k - 1], b = points_[k];
    return {a.x + rest * (b.x - a.x), a.y + rest * (b.y - a.y)};
  }

 private:
  std::vector<Point> points_;
  std::vector<double> lengths_;
};

/// Of each panel, of each edge.
template <class Value>
using PerEdge = std::vector<std::vector<Value>>;

PerEdge<Ruled> rule(const Pattern& pattern) {
  PerEdge<Ruled> ruled;
  for (const Panel& panel : pattern.panels) ruled.emplace_back(panel.begin(), panel.end());
  return ruled;
}

/// Into how many segments each edge is cut.
PerEdge<int> segments_of(const Pattern& pattern, const PerEdge<Ruled>& ruled, double spacing) {
  const auto count = [&](double length) {
    return std::max(1, static_cast<int>(std::lround(length / spacing)));
  };
  PerEdge<int> segments;
  for (const auto& edges : ruled) {
    segments.emplace_back();
    for (const Ruled& edge : edges) segments.back().push_back(count(edge.length()));
  }
  for (const auto& [one, other, opposite] : pattern.seams) {
    const double both =
        ruled[one.panel][one.edge].length() + ruled[other.panel][other.edge].length();
    segments[one.panel][one.edge] = segments[other.panel][other.edge] = count(both / 2);
  }
  return segments;
}

/// The border of a panel; the end of each edge is left to the next one.
std::vector<Point> border_of(const std::vector<Ruled>& edges, const std::vector<int>& segments) {
  std::vector<Point> border;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (int i = 0; i < segments[e]; ++i)
      border.push_back(edges[e].at(static_cast<double>(i) / segments[e]));
  }
  return border;
}

/// Numbers of the vertices along each edge of a panel whose border begins with `first`.
PerEdge<std::uint32_t> edges_of_border(const std::vector<int>& segments, std::uint32_t first) {
  PerEdge<std::uint32_t> edges;
  std::uint32_t next = first;
  for (const int count : segments) {
    edges.emplace_back();
    for (int i = 0; i <= count; ++i) edges.back().push_back(next++);
    --next;  // the end is the next one's start
  }
  edges.back().back() = first;
  return edges;
}

void add_panel(const Triangulation& triangles, std::size_t panel, CutPattern& cut) {
  const auto first = static_cast<std::uint32_t>(cut.flat.size());
  cut.flat.insert(cut.flat.end(), triangles.points.begin(), triangles.points.end());
  cut.panel.resize(cut.flat.size(), panel);
  for (const auto& [a, b, c] : triangles.triangles)
    cut.faces.push_back({first + a, first + b, first + c});
}

void sew(const PanelSeam& seam, CutPattern& cut) {
  const auto& one = cut.edges[seam.one.panel][seam.one.edge];
  const auto& other = cut.edges[seam.other.panel][seam.other.edge];
  for (std::size_t i = 0; i < one.size(); ++i)
    cut.seams.push_back({one[i], other[seam.opposite ? other.size() - 1 - i : i]});
}

}  // namespace

Curve line(Point from, Point to) {
  return [=](double t) {
    return Point{from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)};
  };
}

Curve bent(Point from, Point towards, Point to) {
  return [=](double t) {
    const double a = (1 - t) * (1 - t), b = 2 * t * (1 - t), c = t * t;
    return Point{a * from.x + b * towards.x + c * to.x, a * from.y + b * towards.y + c * to.y};
  };
}

Curve arc(Point centre, double radius, double from, double to) {
  return [=](double t) {
    const double angle = from + t * (to - from);
    return Point{centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
  };
}

Result<CutPattern> cut(const Pattern& pattern, double spacing) {
  const PerEdge<Ruled> ruled = rule(pattern);
  const PerEdge<int> segments = segments_of(pattern, ruled, spacing);
  CutPattern result;
  for (std::size_t panel = 0; panel < pattern.panels.size(); ++panel) {
    const auto triangles = triangulate(border_of(ruled[panel], segments[panel]), spacing);
    if (!triangles) return Error{"panel " + std::to_string(panel) + " is too small for triangles"};
    const auto first = static_cast<std::uint32_t>(result.flat.size());
    result.edges.push_back(edges_of_border(segments[panel], first));
    add_panel(*triangles, panel, result);
  }
  for (const PanelSeam& seam : pattern.seams) sew(seam, result);
  return result;
}

}  // namespace weft::scenes
