#include "tools/scenes/garments.h"
#include "tools/program/measure/fabric_laws.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "tools/scenes/triangulation.h"

namespace weft::scenes {
namespace {

double doubled_area(const CutPattern& cut, const Face& face) {
  const Point a = cut.flat[face[0]], b = cut.flat[face[1]], c = cut.flat[face[2]];
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double length(const CutPattern& cut, std::uint32_t a, std::uint32_t b) {
  return std::hypot(cut.flat[a].x - cut.flat[b].x, cut.flat[a].y - cut.flat[b].y);
}

std::vector<Point> square(int segments) {
  std::vector<Point> border;
  const double step = 1.0 / segments;
  for (int i = 0; i < segments; ++i) border.push_back({step * i, 0});
  for (int i = 0; i < segments; ++i) border.push_back({1, step * i});
  for (int i = 0; i < segments; ++i) border.push_back({1 - step * i, 1});
  for (int i = 0; i < segments; ++i) border.push_back({0, 1 - step * i});
  return border;
}

TEST_CASE("triangles fill the region within a border, each once") {
  for (const int segments : {2, 5, 10, 40}) {
    CAPTURE(segments);
    const auto made = triangulate(square(segments), 1.0 / segments);
    REQUIRE(made);
    double area = 0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
    for (const auto& t : made->triangles) {
      const Point a = made->points[t[0]], b = made->points[t[1]], c = made->points[t[2]];
      const double doubled = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      REQUIRE(doubled > 0);
      area += doubled / 2;
      for (std::size_t i = 0; i < 3; ++i) ++sides[std::minmax(t[i], t[(i + 1) % 3])];
    }
    CHECK(area == doctest::Approx(1));
    const auto once = std::ranges::count(sides, 1, &decltype(sides)::value_type::second);
    CHECK(once == 4 * segments);
  }
}

TEST_CASE("no point is within the circle of another triangle") {
  const auto made = triangulate(square(12), 1.0 / 12);
  REQUIRE(made);
  for (const auto& t : made->triangles) {
    const Point a = made->points[t[0]], b = made->points[t[1]], c = made->points[t[2]];
    const double d = 2 * (a.x * (b.y - c.y) + b.x * (c.y - a.y) + c.x * (a.y - b.y));
    const double a2 = a.x * a.x + a.y * a.y, b2 = b.x * b.x + b.y * b.y, c2 = c.x * c.x + c.y * c.y;
    const Point centre{(a2 * (b.y - c.y) + b2 * (c.y - a.y) + c2 * (a.y - b.y)) / d,
                       (a2 * (c.x - b.x) + b2 * (a.x - c.x) + c2 * (b.x - a.x)) / d};
    const double radius = std::hypot(a.x - centre.x, a.y - centre.y);
    for (const Point& p : made->points)
      REQUIRE(std::hypot(p.x - centre.x, p.y - centre.y) > radius - 1e-9);
  }
}

TEST_CASE("a border that crosses itself has no triangles") {
  CHECK_FALSE(triangulate({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 1));
}

TEST_CASE("curves begin and end where they say") {
  const Curve curves[] = {line({0, 1}, {2, 3}), bent({0, 1}, {5, 5}, {2, 3})};
  for (const Curve& curve : curves) {
    CHECK(curve(0).x == 0);
    CHECK(curve(0).y == 1);
    CHECK(curve(1).x == 2);
    CHECK(curve(1).y == 3);
  }
  const Point top = arc({1, 0}, 2, 0, std::numbers::pi / 2)(1);
  CHECK(top.x == doctest::Approx(1));
  CHECK(top.y == doctest::Approx(2));
}

TEST_CASE("edges that are sewn have as many vertices as each other, ends to ends") {
  // Two unequal triangles, sewn along one edge each, the second one the other way round.
  Pattern pattern;
  pattern.panels = {{line({0, 0}, {1, 0}), line({1, 0}, {0, 1}), line({0, 1}, {0, 0})},
                    {line({0, 0}, {2, 0}), line({2, 0}, {0, 1}), line({0, 1}, {0, 0})}};
  pattern.seams = {{{0, 0}, {1, 0}, true}};
  const CutPattern cut = scenes::cut(pattern, 0.1).value();
  REQUIRE(cut.seams.size() == 16);  // 15 segments of either
  CHECK(cut.edges[0][0].size() == 16);
  CHECK(cut.edges[1][0].size() == 16);
  for (const auto& [a, b] : cut.seams) {
    CHECK(cut.panel[a] == 0);
    CHECK(cut.panel[b] == 1);
    CHECK(cut.flat[b].x == doctest::Approx(2 * (1 - cut.flat[a].x)));
  }
  for (std::size_t panel : {0u, 1u}) {
    for (std::size_t edge = 0; edge < 3; ++edge)
      CHECK(cut.edges[panel][edge].back() == cut.edges[panel][(edge + 1) % 3].front());
  }
}

TEST_CASE("a panel that is too small is named") {
  Pattern pattern;
  pattern.panels = {{line({0, 0}, {1, 0}), line({1, 0}, {0, 1}), line({0, 1}, {0, 0})},
                    {line({0, 0}, {0.01, 0}), line({0.01, 0}, {0, 0})}};
  const auto refused = cut(pattern, 0.1);
  REQUIRE_FALSE(refused);
  CHECK(refused.error() == "panel 1 is too small for triangles");
}

TEST_CASE("clothes have the area of their patterns and triangles of one size, at any resolution") {
  for (const auto& [name, pattern] :
       {std::pair{"tunic", tunic_pattern()}, std::pair{"skirt", skirt_pattern()}}) {
    const CutPattern fine = cut(pattern, 1.0 / 100).value();
    double fine_area = 0;
    for (const Face& face : fine.faces) fine_area += doubled_area(fine, face) / 2;
    for (const int size : {20, 23, 31, 47, 80}) {
      CAPTURE(name);
      CAPTURE(size);
      const double spacing = 1.0 / (size - 1);
      const auto made = cut(pattern, spacing);
      REQUIRE_MESSAGE(made, made.error());
      double area = 0, longest = 0;
      for (const Face& face : made.value().faces) {
        REQUIRE(doubled_area(made.value(), face) > 0);
        area += doubled_area(made.value(), face) / 2;
        for (std::size_t i = 0; i < 3; ++i)
          longest = std::max(longest, length(made.value(), face[i], face[(i + 1) % 3]));
      }
      CHECK(area == doctest::Approx(fine_area).epsilon(0.01));
      CHECK(longest < 2.1 * spacing);
    }
  }
}

TEST_CASE("clothes are sewn into one piece that starts near its rest") {
  for (const char* name : {"tunic", "skirt"}) {
    CAPTURE(name);
    const Scene scene = make_scene(name, {.size = 30}).value();
    const SceneDescription& cloth = scene.description;
    CHECK(cloth.positions.size() < scene.mesh.vertices.size());
    CHECK_FALSE(cloth.fixed.empty());
    double sum = 0;
    for (const MembraneElement& m : cloth.membrane) {
      const auto& [a, b, c] = m.particles;
      const auto& x = cloth.positions;
      const tools::FabricStrain strain = tools::fabric_strain(m, x[a], x[b], x[c]);
      for (const double law : {strain.warp, strain.weft, strain.shear}) {
        REQUIRE(std::abs(law) < 0.04);
        sum += std::abs(law);
      }
    }
    CHECK(sum / static_cast<double>(3 * cloth.membrane.size()) < 0.003);
    std::set<std::uint32_t> joined{0};
    for (bool grew = true; grew;) {
      grew = false;
      for (const MembraneElement& m : cloth.membrane) {
        const auto is_joined = [&](std::uint32_t i) { return joined.contains(i); };
        if (std::ranges::none_of(m.particles, is_joined)) continue;
        for (const std::uint32_t i : m.particles) grew |= joined.insert(i).second;
      }
    }
    CHECK(joined.size() == cloth.positions.size());
  }
}

TEST_CASE("clothes that are too coarse are refused by name") {
  CHECK(make("tunic", {.size = 19}).error() == "tunic: size must be from 20 to 10000, not 19");
}

}  // namespace
}  // namespace weft::scenes
