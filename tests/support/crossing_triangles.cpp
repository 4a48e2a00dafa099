#include "tests/support/crossing_triangles.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <iterator>
#include <variant>

namespace weft::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Feature = std::variant<Kernel::Triangle_3, Kernel::Segment_3, Point>;

using Triangle = std::array<std::uint32_t, 3>;

struct Placed {
  Triangle corners;
  Feature feature;
  CGAL::Bbox_3 box;
};

Feature feature_of(const Point& a, const Point& b, const Point& c) {
  if (!CGAL::collinear(a, b, c)) return Kernel::Triangle_3(a, b, c);
  const Point low = std::min({a, b, c}), high = std::max({a, b, c});  // by coordinates
  if (low == high) return low;
  return Kernel::Segment_3(low, high);
}

std::vector<Placed> place(const TriangleView& view) {
  std::vector<Placed> all;
  for (const auto& t : view.triangles) {
    const auto point = [&](std::size_t k) {
      const Vec3 v = view.points[t[k]];
      return Point(v.x, v.y, v.z);
    };
    const Point a = point(0), b = point(1), c = point(2);
    all.push_back({t, feature_of(a, b, c), a.bbox() + b.bbox() + c.bbox()});
  }
  std::ranges::sort(all, {}, [](const Placed& p) { return p.box.xmin(); });
  return all;
}

bool do_cross(const Feature& a, const Feature& b) {
  return std::visit([](const auto& x, const auto& y) { return CGAL::do_intersect(x, y); }, a, b);
}

}  // namespace

int count_crossings(const TriangleView& a, const TriangleView& b) {
  const std::vector<Placed> of_a = place(a), of_b = place(b);
  int count = 0;
  for (const Placed& one : of_a) {
    for (const Placed& other : of_b) {
      if (other.box.xmin() > one.box.xmax()) break;
      if (CGAL::do_overlap(one.box, other.box) && do_cross(one.feature, other.feature)) ++count;
    }
  }
  return count;
}

namespace {

/// Corners of a that b has not.
std::vector<std::uint32_t> own_corners(const Triangle& a, const Triangle& b) {
  std::vector<std::uint32_t> own;
  std::ranges::copy_if(a, std::back_inserter(own),
                       [&](std::uint32_t corner) { return std::ranges::count(b, corner) == 0; });
  return own;
}

bool is_edge(const Placed& p) { return p.corners[1] == p.corners[2]; }

bool cross_beyond_corners(const TriangleView& s, const Placed& a, const Placed& b) {
  const auto of_a = own_corners(a.corners, b.corners), of_b = own_corners(b.corners, a.corners);
  if (of_a.size() == 3) return do_cross(a.feature, b.feature);
  if (of_a.size() < 2 || is_edge(a) || is_edge(b)) return false;
  const auto side = [&](const std::vector<std::uint32_t>& ends) {
    const Vec3 p = s.points[ends[0]], q = s.points[ends[1]];
    return Feature(Kernel::Segment_3(Point(p.x, p.y, p.z), Point(q.x, q.y, q.z)));
  };
  return do_cross(side(of_a), b.feature) || do_cross(side(of_b), a.feature);
}

}  // namespace

int count_self_crossings(const TriangleView& surface) {
  const std::vector<Placed> all = place(surface);
  int count = 0;
  for (auto a = all.begin(); a != all.end(); ++a) {
    for (auto b = a + 1; b != all.end() && b->box.xmin() <= a->box.xmax(); ++b) {
      if (CGAL::do_overlap(a->box, b->box) && cross_beyond_corners(surface, *a, *b)) ++count;
    }
  }
  return count;
}

}  // namespace weft::test
