#include "engine/ordering/yarns.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/meshes.h"

namespace weft::test::engine_ordering_yarns {
namespace {

/// The first rule that is broken, in words; empty if none is.
std::string fault_of(const WovenYarns& yarns, const Mesh& mesh) {
  std::vector<int> seen(mesh.links.size());
  std::set<std::pair<std::uint32_t, std::uint32_t>> families_at;  // particle, family
  for (const Yarn& yarn : yarns.yarns) {
    const auto particles = yarns.particles_of(yarn);
    const auto links = yarns.links_of(yarn);
    if (links.empty()) return "a yarn without links";
    if (particles.size() != links.size() + (yarn.closed ? 0 : 1)) return "sizes do not match";
    for (std::size_t k = 0; k < links.size(); ++k) {
      const Link& link = mesh.links[links[k]];
      const std::uint32_t from = particles[k], to = particles[(k + 1) % particles.size()];
      if (std::minmax(link.a, link.b) != std::minmax(from, to)) return "not a chain";
      ++seen[links[k]];
    }
    if (yarn.family >= yarns.families) return "families are not counted";
    for (const std::uint32_t p : particles) {
      if (!families_at.insert({p, yarn.family}).second) return "a family twice at a particle";
    }
  }
  const bool once = std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; });
  return once ? "" : "a link in no yarn, or in two";
}

WovenYarns yarns_of(const Mesh& mesh) {
  const WovenYarns yarns = find_yarns(mesh.positions, mesh.links);
  CHECK(fault_of(yarns, mesh) == "");
  return yarns;
}

TEST_CASE("the yarns of a grid are its rows and its columns") {
  Random random(1);
  for (const std::uint32_t rows : {2u, 3u, 8u, 13u}) {
    for (const std::uint32_t columns : {2u, 5u, 8u}) {
      CAPTURE(rows);
      CAPTURE(columns);
      for (const Mesh& mesh : {grid(rows, columns), shuffled(grid(rows, columns), random)}) {
        const WovenYarns yarns = yarns_of(mesh);
        CHECK(yarns.yarns.size() == rows + columns);
        CHECK(yarns.families == 2);
        for (const Yarn& yarn : yarns.yarns) {
          const auto particles = yarns.particles_of(yarn);
          const Vec3 first = mesh.positions[particles.front()];
          const Vec3 last = mesh.positions[particles.back()];
          CHECK((first.x == last.x) != (first.z == last.z));
        }
      }
    }
  }
}

TEST_CASE("the built-in sheets have two families, folded and pinned ones too") {
  Random random(2);
  for (const char* name : {"hang", "hang_sphere", "sphere_drop", "corners"}) {
    for (const int size : {5, 21}) {
      CAPTURE(name);
      CAPTURE(size);
      CHECK(yarns_of(mesh_of(scene_of(name, size))).families == 2);
      CHECK(yarns_of(shuffled(mesh_of(scene_of(name, size)), random)).families == 2);
    }
  }
}

TEST_CASE("bending links make yarns of their own, behind those they skip over") {
  Random random(3);
  Mesh mesh = grid(12, 30);
  const std::size_t structural = mesh.links.size();
  add_bending(mesh, 12, 30, ConstraintKind::distance);
  const WovenYarns yarns = yarns_of(mesh);
  for (const Yarn& yarn : yarns.yarns) {
    const auto links = yarns.links_of(yarn);
    for (const std::uint32_t link : links) CHECK((link < structural) == (links[0] < structural));
    if (yarn.family < 2) CHECK(links[0] < structural);
  }
  CHECK(yarns_of(shuffled(mesh, random)).yarns.size() == yarns.yarns.size());
}

TEST_CASE("a chain is one yarn, a ring one closed yarn") {
  const WovenYarns line = yarns_of(chain(20));
  REQUIRE(line.yarns.size() == 1);
  CHECK(!line.yarns[0].closed);
  CHECK(line.particles_of(line.yarns[0]).size() == 20);
  const WovenYarns circle = yarns_of(ring(20));
  REQUIRE(circle.yarns.size() == 1);
  CHECK(circle.yarns[0].closed);
  CHECK(circle.particles_of(circle.yarns[0]).size() == 20);
}

TEST_CASE("a yarn turns by less than 60 degrees") {
  CHECK(yarns_of(ring(5)).yarns.size() == 5);
  CHECK(yarns_of(ring(7)).yarns.size() == 1);
}

TEST_CASE("a chain that meets itself is cut") {
  // A loop that is entered and left through particle 0, straight on.
  Mesh mesh = ring(16);
  const Vec3 at = mesh.positions[0];
  const auto before = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back({at.x, at.y - 1, at.z + 0.3});
  mesh.positions.push_back({at.x, at.y + 1, at.z + 0.3});
  mesh.links.push_back({before, 0, ConstraintKind::distance});
  mesh.links.push_back({0, before + 1, ConstraintKind::distance});
  for (const std::uint32_t first : {1u, 15u}) {
    std::rotate(mesh.links.begin(), mesh.links.begin() + first, mesh.links.end());
    yarns_of(mesh);
  }
}

TEST_CASE("any graph is covered") {
  Random random(4);
  for (std::uint32_t i = 0; i < 30; ++i) {
    CAPTURE(i);
    yarns_of(random_graph(60, 20 * i, 16, random));
    yarns_of(triangles(10, 12, 0.03 * i, 0.02 * i, random));
  }
}

TEST_CASE("hubs end yarns") {
  Mesh star;
  Random random(5);
  star.positions.push_back({0, 0, 0});
  for (std::uint32_t i = 1; i <= 100; ++i) {
    star.positions.push_back(random.in_box(1));
    star.links.push_back({0, i, ConstraintKind::distance});
  }
  CHECK(yarns_of(star).yarns.size() == 100);
}

TEST_CASE("particles in one place, and no particles at all") {
  Mesh mesh = grid(4, 4);
  for (Vec3& p : mesh.positions) p = {1, 2, 3};
  CHECK(yarns_of(mesh).yarns.size() == mesh.links.size());
  CHECK(yarns_of(Mesh{}).families == 0);
}

}  // namespace
}  // namespace weft::test::engine_ordering_yarns
