#include "tests/support/crossing_triangles.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <variant>

namespace weft::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Feature = std::variant<Kernel::Triangle_3, Kernel::Segment_3, Point>;

struct Placed {
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
    all.push_back({feature_of(a, b, c), a.bbox() + b.bbox() + c.bbox()});
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

}  // namespace weft::test
