/// The topology of surfaces: who owns what, and who is beside whom.
#include <doctest/doctest.h>

#include <weft/scene.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include "engine/triangles/triangle_surface.h"
#include "tests/support/random.h"

namespace weft::test::engine_triangles_triangle_surface {
namespace {

using Triangles = std::vector<TriangleSurface::Triangle>;
using Places = std::vector<std::array<double, 3>>;

/// A sheet of triangles with holes, in any order and direction, and points that none of them has.
struct Patch {
  Triangles triangles;
  Places places;
  std::vector<std::uint32_t> loose;

  Patch(std::uint32_t size, Random& random) {
    for (std::uint32_t i = 0; i < size * size; ++i) {
      places.push_back({double{1} * (i % size), double{1} * (i / size), random.between(-1, 1)});
    }
    for (std::uint32_t y = 0; y + 1 < size; ++y) {
      for (std::uint32_t x = 0; x + 1 < size; ++x) {
        const std::uint32_t p = y * size + x;
        if (random.below(5) != 0) triangles.push_back({p, p + 1, p + size});
        if (random.below(5) != 0) triangles.push_back({p + 1, p + size + 1, p + size});
      }
    }
    const std::vector<std::uint32_t> order =
        random.permutation(static_cast<std::uint32_t>(triangles.size()));
    Triangles mixed;
    for (const std::uint32_t t : order) {
      mixed.push_back(triangles[t]);
      std::ranges::rotate(mixed.back(), mixed.back().begin() + random.below(3));
    }
    triangles = mixed;
    std::set<std::uint32_t> used;
    for (const TriangleSurface::Triangle& t : triangles) used.insert(t.begin(), t.end());
    for (std::uint32_t p = 0; p < places.size(); ++p) {
      if (!used.contains(p)) loose.push_back(p);
    }
  }
};

using Ends = std::array<std::uint32_t, 2>;
Ends ends(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

/// Per edge: third corners of the triangles that have it.
std::map<Ends, std::vector<std::uint32_t>> thirds_of(const Triangles& triangles) {
  std::map<Ends, std::vector<std::uint32_t>> thirds;
  for (const TriangleSurface::Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k)
      thirds[ends(t[k], t[(k + 1) % 3])].push_back(t[(k + 2) % 3]);
  }
  return thirds;
}

void check_owners(const TriangleSurface& s) {
  std::vector<int> of_point(s.triangles_at.size()), of_edge(s.edges.size());
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (s.owns_corner(t, k)) ++of_point[s.triangles[t][k]];
      if (s.owns_edge(t, k)) ++of_edge[s.edges_of[t][k]];
    }
  }
  CHECK(std::ranges::all_of(of_point, [](int n) { return n == 1; }));
  CHECK(std::ranges::all_of(of_edge, [](int n) { return n == 1; }));
}

void check_edges(const TriangleSurface& s, const Triangles& triangles) {
  auto thirds = thirds_of(triangles);
  REQUIRE(s.edges.size() == thirds.size());
  REQUIRE(s.opposite.size() == thirds.size());
  for (std::size_t e = 0; e < s.edges.size(); ++e) {
    std::vector<std::uint32_t> known = thirds.at(s.edges[e]), found;
    for (const std::uint32_t third : s.opposite[e]) {
      if (third != kNoIndex) found.push_back(third);
    }
    CHECK(found.size() == std::min<std::size_t>(2, known.size()));
    for (const std::uint32_t third : found) CHECK(std::ranges::find(known, third) != known.end());
    if (found.size() == 2 && known.size() == 2) CHECK(std::ranges::is_permutation(found, known));
  }
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Ends side = ends(s.triangles[t][k], s.triangles[t][(k + 1) % 3]);
      CHECK(s.edges[s.edges_of[t][k]] == side);
    }
  }
}

void check_neighbours(const TriangleSurface& s, const Triangles& triangles) {
  const auto thirds = thirds_of(triangles);
  std::size_t joined = 0;
  for (std::uint32_t p = 0; p < s.triangles_at.size(); ++p) {
    const auto at = s.triangles_at[p];
    std::size_t count = 0;
    bool has_open_edge = false;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const bool has = std::ranges::find(triangles[t], p) != triangles[t].end();
      count += has;
      CHECK((std::ranges::find(at, t) != at.end()) == has);
    }
    CHECK(at.size() == count);
    for (const std::uint32_t other : s.neighbours[p]) {
      const auto found = thirds.find(ends(p, other));
      REQUIRE(found != thirds.end());
      has_open_edge = has_open_edge || found->second.size() == 1;
      ++joined;
    }
    if (count > 0) CHECK(s.is_on_border(p) == has_open_edge);
  }
  CHECK(joined == 2 * thirds.size());
}

TEST_CASE("every corner and edge of a surface is owned once, and knows what is beside it") {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const Patch patch(3 + random.below(5), random);
    const TriangleSurface s = make_triangle_surface(patch.triangles, patch.places, patch.loose);
    REQUIRE(s.triangles.size() == patch.triangles.size() + patch.loose.size());
    check_owners(s);
    check_edges(s, patch.triangles);
    check_neighbours(s, patch.triangles);
    for (std::uint32_t t = 0; t < s.triangles.size(); ++t)
      CHECK(s.is_point(t) == (t >= patch.triangles.size()));
    std::vector<std::uint32_t> order = s.in_order;
    std::ranges::sort(order);
    for (std::uint32_t t = 0; t < order.size(); ++t) CHECK(order[t] == t);
    CHECK(order.size() == s.triangles.size());
  }
}

TEST_CASE("triangles stand beside others that are near to them") {
  Random random(1);
  const Patch patch(24, random);
  const TriangleSurface s = make_triangle_surface(patch.triangles, patch.places, patch.loose);
  double in_order = 0, as_given = 0;
  const auto distance = [&](std::uint32_t t, std::uint32_t u) {
    const auto &a = patch.places[s.triangles[t][0]], &b = patch.places[s.triangles[u][0]];
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  };
  for (std::uint32_t t = 1; t < s.triangles.size(); ++t) {
    in_order += distance(s.in_order[t - 1], s.in_order[t]);
    as_given += distance(t - 1, t);
  }
  CHECK(in_order < 0.3 * as_given);
}

TEST_CASE("an edge of three triangles knows two of them; one triangle is all border") {
  const Places places{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
  const Triangles book{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  const TriangleSurface s = make_triangle_surface(book, places, {});
  check_owners(s);
  check_edges(s, book);
  const Triangles one{{2, 0, 1}};
  const std::vector<std::uint32_t> loose{3, 4};
  const TriangleSurface single = make_triangle_surface(one, places, loose);
  check_owners(single);
  for (std::uint32_t p = 0; p < 3; ++p) CHECK(single.is_on_border(p));
  const Triangles tetrahedron{{0, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 0, 4}};
  const std::vector<std::uint32_t> rest{3};
  const TriangleSurface closed = make_triangle_surface(tetrahedron, places, rest);
  check_owners(closed);
  for (const std::uint32_t p : {0u, 1u, 2u, 4u}) CHECK_FALSE(closed.is_on_border(p));
}

TEST_CASE("a thread owns its edge and its ends, and leaves the border of faces as it is") {
  const Places places{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0, 0}, {3, 0, 0}, {9, 9, 9}};
  const Triangles tetrahedron{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const std::vector<std::uint32_t> loose{6};
  const std::vector<std::array<std::uint32_t, 2>> threads{{1, 4}, {4, 5}};
  const TriangleSurface s = make_triangle_surface(tetrahedron, places, loose, threads);
  check_owners(s);
  CHECK(s.has_threads);
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    CHECK(s.is_face(t) == (t < 4));
    CHECK(s.is_thread(t) == (t == 4 || t == 5));
    CHECK(s.is_point(t) == (t == 6));
  }
  CHECK(s.edges.size() == 8);
  for (std::uint32_t e = 0; e < s.edges.size(); ++e)
    CHECK(s.is_thread_edge(e) == (s.edges[e][1] > 3));
  CHECK(std::ranges::count(s.edges_of[4], s.edges_of[4][0]) == 3);
  CHECK(s.triangles_at[1].size() == 4);
  CHECK(s.triangles_at[4].size() == 2);
  CHECK_FALSE(s.is_on_border(1));
  CHECK_FALSE(make_triangle_surface(tetrahedron, places, loose).has_threads);
}

TEST_CASE("points alone, and nothing at all, are surfaces") {
  const Places places{{0, 0, 0}, {1, 0, 0}};
  const std::vector<std::uint32_t> loose{0, 1};
  const TriangleSurface points = make_triangle_surface({}, places, loose);
  check_owners(points);
  CHECK(points.edges.empty());
  CHECK(points.is_point(1));
  CHECK(make_triangle_surface({}, {}, {}).triangles.empty());
}

}  // namespace
}  // namespace weft::test::engine_triangles_triangle_surface
