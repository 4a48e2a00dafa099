#include "tools/scenes/triangulation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>

#include "tools/scenes/splitmix.h"

namespace weft::scenes {
namespace {

constexpr std::uint64_t kInnerPointsSeed = 1934;
constexpr double kMoved = 0.15;      // of the spacing, along each axis
constexpr double kClearance = 0.65;  // of the spacing, between inner points and the border

/// Twice the area of a triangle, above 0 if it is counterclockwise.
double doubled_area(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether p is within the circle through the corners of a counterclockwise triangle.
bool in_circle(Point a, Point b, Point c, Point p) {
  const double ax = a.x - p.x, ay = a.y - p.y;
  const double bx = b.x - p.x, by = b.y - p.y;
  const double cx = c.x - p.x, cy = c.y - p.y;
  const double a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  return ax * (by * c2 - b2 * cy) - ay * (bx * c2 - b2 * cx) + a2 * (bx * cy - by * cx) > 0;
}

/// The triangles of all points so far, by the algorithm of Bowyer and Watson (1981): those whose
/// circle a new point is within make way for a fan around it.
class Delaunay {
 public:
  /// All points are within `size` of the middle.
  Delaunay(Point middle, double size) {
    constexpr double kFar = 20;
    for (const auto& [x, y] : {std::pair{-1.0, -0.6}, {1.0, -0.6}, {0.0, 1.2}})
      points_.push_back({middle.x + kFar * size * x, middle.y + kFar * size * y});
    triangles_.push_back({{0, 1, 2}, {kNone, kNone, kNone}, true});
  }

  /// Fast where each point is near the one before it. False where p lies on another point.
  bool add(Point p) {
    const std::uint32_t first = find(p);
    if (first == kNone) return false;
    const auto number = static_cast<std::uint32_t>(points_.size());
    points_.push_back(p);
    const std::vector<Side> hole = open(first, p);
    fill(hole, number);
    return true;
  }

  /// Without the three far corners, numbers from the first point that was added.
  std::vector<std::array<std::uint32_t, 3>> triangles() const {
    std::vector<std::array<std::uint32_t, 3>> found;
    for (const Triangle& t : triangles_) {
      if (!t.lives || std::ranges::min(t.corners) < kFarCorners) continue;
      found.push_back(
          {t.corners[0] - kFarCorners, t.corners[1] - kFarCorners, t.corners[2] - kFarCorners});
    }
    return found;
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr std::uint32_t kFarCorners = 3;

  struct Triangle {
    std::array<std::uint32_t, 3> corners{};
    std::array<std::uint32_t, 3> beyond{};  ///< the triangle across the side after each corner
    bool lives = true;
  };
  /// A side of the hole, from a to b with the hole on its left, and what is beyond it.
  struct Side {
    std::uint32_t a, b, beyond;
  };

  /// A triangle that gives way to p: the one that a walk from the last one leads to. Rounding may
  /// keep a walk from ending; then all are looked at. kNone: none gives way.
  std::uint32_t find(Point p) const {
    std::uint32_t at = last_;
    for (std::size_t steps = 0; steps < triangles_.size(); ++steps) {
      const std::uint32_t next = step_towards(at, p);
      if (next == kNone) return gives_way(triangles_[at], p) ? at : kNone;
      at = next;
    }
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      if (triangles_[i].lives && gives_way(triangles_[i], p)) return i;
    }
    return kNone;
  }

  /// Across a side that p is beyond; kNone: there is none.
  std::uint32_t step_towards(std::uint32_t at, Point p) const {
    const Triangle& t = triangles_[at];
    for (std::size_t i = 0; i < 3; ++i) {
      const Point a = points_[t.corners[i]], b = points_[t.corners[(i + 1) % 3]];
      if (doubled_area(a, b, p) < 0 && t.beyond[i] != kNone) return t.beyond[i];
    }
    return kNone;
  }

  bool gives_way(const Triangle& t, Point p) const {
    return in_circle(points_[t.corners[0]], points_[t.corners[1]], points_[t.corners[2]], p);
  }

  /// Ends the triangles that give way, from one of them on. Returns the sides of the hole.
  std::vector<Side> open(std::uint32_t first, Point p) {
    std::vector<Side> sides;
    std::vector<std::uint32_t> opened{first};
    triangles_[first].lives = false;
    for (std::size_t k = 0; k < opened.size(); ++k) {
      const Triangle t = triangles_[opened[k]];
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t next = t.beyond[i];
        if (next != kNone && !triangles_[next].lives) continue;
        if (next != kNone && gives_way(triangles_[next], p)) {
          triangles_[next].lives = false;
          opened.push_back(next);
        } else {
          sides.push_back({t.corners[i], t.corners[(i + 1) % 3], next});
        }
      }
    }
    return sides;
  }

  void fill(const std::vector<Side>& hole, std::uint32_t point) {
    const auto first = static_cast<std::uint32_t>(triangles_.size());
    const auto starting_at = [&](std::uint32_t corner) {
      const auto side = std::ranges::find(hole, corner, &Side::a);
      return first + static_cast<std::uint32_t>(side - hole.begin());
    };
    const auto ending_at = [&](std::uint32_t corner) {
      const auto side = std::ranges::find(hole, corner, &Side::b);
      return first + static_cast<std::uint32_t>(side - hole.begin());
    };
    for (const Side& side : hole) {
      const auto own = static_cast<std::uint32_t>(triangles_.size());
      triangles_.push_back(
          {{side.a, side.b, point}, {side.beyond, starting_at(side.b), ending_at(side.a)}, true});
      if (side.beyond != kNone) join(side.beyond, side.b, own);
    }
    last_ = first;
  }

  /// The triangle across the side that begins at the corner is another one now.
  void join(std::uint32_t triangle, std::uint32_t corner, std::uint32_t beyond) {
    Triangle& t = triangles_[triangle];
    for (std::size_t i = 0; i < 3; ++i) {
      if (t.corners[i] == corner) t.beyond[i] = beyond;
    }
  }

  std::vector<Point> points_;
  std::vector<Triangle> triangles_;
  std::uint32_t last_ = 0;
};

/// Whether a ray to the right crosses the border an odd number of times.
bool is_within(const std::vector<Point>& border, Point p) {
  bool within = false;
  for (std::size_t i = 0; i < border.size(); ++i) {
    const Point a = border[i], b = border[(i + 1) % border.size()];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    if (p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) within = !within;
  }
  return within;
}

double distance_to(Point a, Point b, Point p) {
  const double x = b.x - a.x, y = b.y - a.y;
  const double along = ((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y);
  const double share = std::clamp(along, 0.0, 1.0);
  return std::hypot(a.x + share * x - p.x, a.y + share * y - p.y);
}

double distance_to(const std::vector<Point>& border, Point p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < border.size(); ++i)
    least = std::min(least, distance_to(border[i], border[(i + 1) % border.size()], p));
  return least;
}

struct Box {
  Point least, most;
};
Box box_of(const std::vector<Point>& points) {
  Box box{points[0], points[0]};
  for (const Point& p : points) {
    box.least = {std::min(box.least.x, p.x), std::min(box.least.y, p.y)};
    box.most = {std::max(box.most.x, p.x), std::max(box.most.y, p.y)};
  }
  return box;
}

/// Near those of a lattice of equilateral triangles, row by row.
std::vector<Point> inner_points(const std::vector<Point>& border, double spacing) {
  SplitMix random(kInnerPointsSeed);
  const auto moved = [&] { return kMoved * spacing * (2 * random.unit() - 1); };
  const auto [least, most] = box_of(border);
  const double height = std::sqrt(0.75) * spacing;
  const auto rows = static_cast<int>((most.y - least.y) / height);
  const auto columns = static_cast<int>((most.x - least.x) / spacing) + 1;
  std::vector<Point> points;
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const double x = moved(), y = moved();
      const Point p{least.x + spacing * (column + 0.5 * (row % 2)) + x,
                    least.y + height * (row + 0.5) + y};
      const bool is_inner = is_within(border, p) && distance_to(border, p) > kClearance * spacing;
      if (is_inner) points.push_back(p);
    }
  }
  return points;
}

bool has_border(const std::vector<std::array<std::uint32_t, 3>>& triangles, std::uint32_t count) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
  for (const auto& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (t[i] < count && t[(i + 1) % 3] < count) sides.insert({t[i], t[(i + 1) % 3]});
    }
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!sides.contains({i, (i + 1) % count})) return false;
  }
  return true;
}

}  // namespace

std::optional<Triangulation> triangulate(const std::vector<Point>& border, double spacing) {
  Triangulation result;
  result.points = border;
  const std::vector<Point> inner = inner_points(border, spacing);
  result.points.insert(result.points.end(), inner.begin(), inner.end());
  const auto [least, most] = box_of(border);
  Delaunay delaunay({(least.x + most.x) / 2, (least.y + most.y) / 2},
                    std::max(most.x - least.x, most.y - least.y));
  for (const Point& p : result.points) {
    if (!delaunay.add(p)) return std::nullopt;
  }
  for (const auto& triangle : delaunay.triangles()) {
    Point middle;
    for (const std::uint32_t corner : triangle) {
      middle.x += result.points[corner].x / 3;
      middle.y += result.points[corner].y / 3;
    }
    if (is_within(border, middle)) result.triangles.push_back(triangle);
  }
  if (!has_border(result.triangles, static_cast<std::uint32_t>(border.size()))) return std::nullopt;
  return result;
}

}  // namespace weft::scenes
