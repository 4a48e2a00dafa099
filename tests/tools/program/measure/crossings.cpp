#include "tools/program/measure/crossings.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "tests/support/crossing_triangles.h"
#include "tools/scenes/body_meshes.h"
#include "tools/studies/hard/mesh_oracle.h"

namespace weft::tools {
namespace {

TriangleSet one(Vec3 a, Vec3 b, Vec3 c) { return {{a, b, c}, {{0, 1, 2}}}; }

TriangleSet level() { return one({0, 0, 0}, {0, 0, 1}, {1, 0, 0}); }

TriangleSet set_of(const TriangleMesh& mesh) { return {mesh.vertices, mesh.triangles}; }

TEST_CASE("triangles cross where an edge of one leads through the other") {
  CHECK(count_crossings(level(), one({0.2, -1, 0.2}, {0.2, 1, 0.2}, {5, 1, 5})) == 1);
  CHECK(count_crossings(one({0.2, -1, 0.2}, {0.2, 1, 0.2}, {5, 1, 5}), level()) == 1);
  CHECK(count_crossings(level(), one({0.2, 0.1, 0.2}, {0.2, 1, 0.2}, {5, 1, 5})) == 0);
  CHECK(count_crossings(level(), one({0.9, -1, 0.9}, {0.9, 1, 0.9}, {5, 1, 5})) == 0);
}

TEST_CASE("what leads through an edge or a corner crosses, what only touches does not") {
  CHECK(count_crossings(level(), one({0, -1, 0.5}, {0, 1, 0.5}, {-5, 1, 5})) == 1);
  CHECK(count_crossings(level(), one({0, -1, 0}, {0, 1, 0}, {-5, 1, 5})) == 1);
  CHECK(count_crossings(level(), one({0.2, 0, 0.2}, {0.2, 1, 0.2}, {5, 1, 5})) == 0);
  CHECK(count_crossings(level(), level()) == 0);
}

TEST_CASE("triangles without area cross by their edges") {
  CHECK(count_crossings(level(), one({0.2, -1, 0.2}, {0.2, 0, 0.2}, {0.2, 1, 0.2})) == 1);
}

TEST_CASE("far from the origin too") {
  TriangleSet ball = set_of(scenes::ball_mesh({.radius = 0.5}, 16));
  TriangleSet sheet = set_of(scenes::plate_mesh(2, 2, 9, 9));
  for (Vec3& p : sheet.places) p = {p.x + 0.007, 0.013, p.z + 0.003};  // nothing meets a vertex
  const std::size_t crossings = count_crossings(ball, sheet);
  CHECK(crossings > 16);
  for (TriangleSet* set : {&ball, &sheet}) {
    for (Vec3& p : set->places) p = {p.x + 16384, p.y - 16384, p.z + 16384};
  }
  CHECK(count_crossings(ball, sheet) == crossings);
}

/// Triangles as large as `size`, anywhere in a box of a metre.
TriangleSet random_triangles(std::mt19937& random, std::uint32_t count, double size) {
  std::uniform_real_distribution<double> number(-0.5, 0.5);
  TriangleSet set;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 at{number(random), number(random), number(random)};
    for (int k = 0; k < 3; ++k) {
      set.places.push_back({at.x + size * number(random), at.y + size * number(random),
                            at.z + size * number(random)});
    }
    set.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return set;
}

TriangleSet single(const TriangleSet& set, std::size_t triangle) {
  return {set.places, {set.triangles[triangle]}};
}

TEST_CASE("of many triangles none is missed, nor a pair that is near") {
  std::mt19937 random(7);
  for (const double size : {0.05, 0.3, 1.0}) {
    const TriangleSet a = random_triangles(random, 120, size),
                      b = random_triangles(random, 90, size);
    std::size_t crossings = 0;
    double least = 0.1;
    for (std::size_t i = 0; i < a.triangles.size(); ++i) {
      for (std::size_t j = 0; j < b.triangles.size(); ++j) {
        crossings += count_crossings(single(a, i), single(b, j));
        least = std::min(least, hard::distance(single(a, i), single(b, j), 0.1));
      }
    }
    CHECK(count_crossings(a, b) == crossings);
    CHECK(hard::distance(a, b, 0.1) == least);
  }
}

/// A sheet of n x n vertices, each of which is anywhere near its place.
TriangleSet crumpled_sheet(std::mt19937& random, std::uint32_t n, double by) {
  std::uniform_real_distribution<double> number(-by, by);
  TriangleSet sheet;
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i)
      sheet.places.push_back({i + number(random), number(random), j + number(random)});
  }
  for (std::uint32_t j = 0; j + 1 < n; ++j) {
    for (std::uint32_t i = 0; i + 1 < n; ++i) {
      const std::uint32_t a = n * j + i, b = a + n;
      sheet.triangles.push_back({a, b, a + 1});
      sheet.triangles.push_back({b, b + 1, a + 1});
    }
  }
  return sheet;
}

TEST_CASE("a crumpled sheet crosses itself where exact predicates say so") {
  std::mt19937 random(23);
  std::size_t crossed = 0;
  for (int mesh = 0; mesh < 300; ++mesh) {
    CAPTURE(mesh);
    const double by = std::uniform_real_distribution<double>(0.2, 1.5)(random);
    const TriangleSet sheet = crumpled_sheet(random, 6, by);
    const std::size_t count = count_crossings(sheet);
    CHECK(count == test::count_self_crossings({sheet.places, sheet.triangles}));
    crossed += count > 0 ? 1 : 0;
  }
  CHECK(crossed > 50);
  CHECK(crossed < 300);
}

TEST_CASE("a sheet folded flat onto itself crosses nothing, and through itself it does") {
  TriangleSet sheet{{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 0}, {2, 0, 1}},
                    {{0, 2, 1}, {2, 3, 1}, {1, 3, 4}, {3, 5, 4}}};
  CHECK(count_crossings(sheet) == 0);
  sheet.places[4] = {0.1, 0, 0.1}, sheet.places[5] = {0.1, 0, 0.9};
  CHECK(count_crossings(sheet) == 0);
  sheet.places[4].y = 0.3, sheet.places[5].y = -0.3;
  CHECK(count_crossings(sheet) > 0);
}

/// Diagonals of cells that lie beside each other seemed to cross by the rounding of volumes.
TEST_CASE("a level sheet whose heights differ by rounding crosses nothing") {
  constexpr std::uint32_t kSize = 10;
  std::mt19937 random(1);
  std::uniform_int_distribution<int> ulps(-2, 2);
  for (int attempt = 0; attempt < 20; ++attempt) {
    TriangleSet sheet;
    for (std::uint32_t i = 0; i < kSize; ++i) {
      for (std::uint32_t j = 0; j < kSize; ++j)
        sheet.places.push_back({0.4 / 9 * i, 1e-3 + ulps(random) * 2e-19, 0.4 / 9 * j});
    }
    for (std::uint32_t a = 0; a + kSize < kSize * kSize; ++a) {
      if (a % kSize + 1 == kSize) continue;
      sheet.triangles.push_back({a, a + 1, a + kSize + 1});
      sheet.triangles.push_back({a, a + kSize + 1, a + kSize});
    }
    CHECK(test::count_self_crossings({sheet.places, sheet.triangles}) == 0);
    CHECK(count_crossings(sheet) == 0);
  }
}

TEST_CASE("the first crossing is named by triangle, body and place") {
  const TriangleSet cloth{{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {5, 0, 0}, {6, 0, 0}, {5, 0, 1}},
                          {{0, 1, 2}, {3, 4, 5}}};
  const auto beside = [](double x) {
    TriangleMesh mesh;
    mesh.vertices = {{x, -1, 0.2}, {x, 1, 0.2}, {x, 0, 9}};
    mesh.triangles = {{0, 1, 2}};
    return SceneBody{.shape = mesh};
  };
  const SceneBody bodies[] = {beside(3), beside(5.2)};
  const NamedCrossing named = name_crossing(cloth, bodies, 0);
  CHECK(named.count == 1);
  CHECK(named.triangle == 1);
  CHECK(named.body == 1);
  CHECK(named.place.x == doctest::Approx(16. / 3));
  CHECK(name_crossing(cloth, std::span(bodies).first(1), 0).count == 0);
}

TEST_CASE("meshes that are made are closed and turned outwards") {
  for (const TriangleMesh& mesh :
       {scenes::ball_mesh({{1, 2, 3}, 0.5}, 12),
        scenes::capsule_mesh({{}, {1, 0, 0}, 0.1, 0.3}, 16), scenes::box_mesh({1, 2, 3}, 3)}) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
    double volume = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
      for (const auto& side : {std::pair{a, b}, {b, c}, {c, a}}) CHECK(sides.insert(side).second);
      const Vec3 p = mesh.vertices[a], q = mesh.vertices[b], r = mesh.vertices[c];
      volume += p.x * (q.y * r.z - q.z * r.y) + p.y * (q.z * r.x - q.x * r.z) +
                p.z * (q.x * r.y - q.y * r.x);
    }
    for (const auto& [a, b] : sides) CHECK(sides.contains({b, a}));
    CHECK(volume > 0);
  }
}

}  // namespace
}  // namespace weft::tools
