#include "engine/ordering/ordering.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/meshes.h"
#include "tests/support/orderings.h"

namespace weft::test::engine_ordering_ordering {
namespace {

Ordering order_of(const Mesh& mesh, const OrderingOptions& options = {}) {
  const Ordering ordering = order(mesh.positions, mesh.links, {}, options);
  CHECK(fault_of(ordering, mesh.links, mesh.positions.size()) == "");
  return ordering;
}

std::uint32_t longest_run(const Ordering& ordering) {
  std::uint32_t longest = 0;
  for (const Run& run : ordering.runs) longest = std::max(longest, run.length);
  return longest;
}

bool equal(const Ordering& x, const Ordering& y) {
  return x.particle_at == y.particle_at && x.link_at == y.link_at && x.a == y.a && x.b == y.b &&
         x.batches.size() == y.batches.size() && x.tiles.size() == y.tiles.size();
}

/// From 6 x 6 on there is a lane full of links in each batch.
void check_grid(const Mesh& mesh) {
  const Ordering ordering = order_of(mesh);
  CHECK(ordering.run_share == 1.0);
  const std::size_t tiles = mesh.positions.size() >= 1000 ? 2 : 1;
  CHECK(ordering.tiles.size() == tiles);
  CHECK(ordering.colours == 3 + tiles);
  CHECK(ordering.runs.size() <= 18);
  const double waste = static_cast<double>(ordering.constraint_slots());
  CHECK(waste <= 1.2 * static_cast<double>(mesh.links.size()) + 8 * kLanes);
}

TEST_CASE("grids are runs throughout, whatever their particles' numbers") {
  Random random(1);
  for (const std::uint32_t rows : {6u, 7u, 10u, 20u, 21u, 40u, 41u}) {
    for (const std::uint32_t columns : {6u, 9u, 20u, 33u, 40u, 41u}) {
      CAPTURE(rows);
      CAPTURE(columns);
      check_grid(grid(rows, columns));
      check_grid(shuffled(grid(rows, columns), random));
    }
  }
}

TEST_CASE("the smallest grids are ordered too") {
  for (std::uint32_t rows = 1; rows < 8; ++rows) {
    for (std::uint32_t columns = 1; columns < 8; ++columns) {
      CAPTURE(rows);
      CAPTURE(columns);
      CHECK(order_of(grid(rows, columns)).colours <= 4);
    }
  }
}

TEST_CASE("the built-in sheets are runs throughout") {
  Random random(2);
  for (const char* name : {"hang", "hang_sphere", "sphere_drop", "corners"}) {
    for (const int size : {9, 21, 41}) {
      CAPTURE(name);
      CAPTURE(size);
      const Mesh mesh = mesh_of(scene_of(name, size));
      CHECK(order_of(mesh).run_share == 1.0);
      CHECK(order_of(shuffled(mesh, random)).run_share == 1.0);
    }
  }
}

TEST_CASE("pinned particles leave the rest in runs") {
  for (const std::uint32_t size : {12u, 20u, 41u}) {
    CAPTURE(size);
    Mesh border = grid(size, size);
    pin(border, [&](std::uint32_t p) {
      const std::uint32_t row = p / size, column = p % size;
      return row == 0 || row == size - 1 || column == 0 || column == size - 1;
    });
    CHECK(order_of(border).run_share == 1.0);
    Mesh middle = grid(size, size);
    pin(middle, [&](std::uint32_t p) { return p / size == size / 2; });
    CHECK(order_of(middle).run_share == 1.0);
  }
}

TEST_CASE("diagonals as ropes are runs in batches of their own") {
  Random random(3);
  for (const std::uint32_t size : {10u, 20u, 41u}) {
    CAPTURE(size);
    Mesh mesh = grid(size, size);
    add_diagonals(mesh, size, size, ConstraintKind::rope);
    for (const Mesh& m : {mesh, shuffled(mesh, random)}) {
      const Ordering ordering = order_of(m);
      CHECK(ordering.run_share == 1.0);
      CHECK(ordering.colours <= 11);
    }
  }
}

TEST_CASE("links that skip a particle are runs") {
  Random random(4);
  for (const std::uint32_t size : {20u, 41u}) {
    CAPTURE(size);
    Mesh mesh = grid(size, size);
    add_diagonals(mesh, size, size, ConstraintKind::distance);
    add_bending(mesh, size, size, ConstraintKind::rope);
    CHECK(order_of(mesh).run_share > 0.99);
    CHECK(order_of(shuffled(mesh, random)).run_share > 0.99);
  }
}

TEST_CASE("chains, rings and tubes") {
  for (const std::uint32_t particles : {1u, 2u, 3u, 20u, 31u, 999u, 1000u, 20'000u}) {
    CAPTURE(particles);
    const Ordering ordering = order_of(chain(particles));
    CHECK(ordering.colours <= (particles < 1000 ? 2 : 3));
    if (particles >= 20) CHECK(ordering.run_share > 0.99);
  }
  for (const std::uint32_t particles : {3u, 4u, 7u, 30u, 101u}) order_of(ring(particles));
  CHECK(order_of(ring(500)).run_share > 0.99);
  CHECK(order_of(tube(40, 50)).run_share > 0.98);
  CHECK(order_of(tube(50, 31)).run_share > 0.98);
}

TEST_CASE("several parts and lone particles") {
  Random random(5);
  Mesh mesh = both(grid(20, 20), both(chain(50), both(ring(31), grid(40, 11))));
  mesh.positions.resize(mesh.positions.size() + 30);
  CHECK(order_of(mesh).run_share > 0.99);
  CHECK(order_of(shuffled(mesh, random)).run_share > 0.99);
  Mesh ropes;
  for (int i = 0; i < 60; ++i) ropes = both(ropes, chain(30));
  CHECK(order_of(ropes).run_share == 1.0);
}

TEST_CASE("sheets with holes and round sheets") {
  constexpr std::uint32_t kSize = 60;
  const auto cut = [](bool inside, int radius) {
    Mesh mesh = grid(kSize, kSize);
    const auto gone = [=](std::uint32_t p) {
      const int row = static_cast<int>(p / kSize) - 30, column = static_cast<int>(p % kSize) - 30;
      return (row * row + column * column < radius * radius) == inside;
    };
    std::erase_if(mesh.links, [&](const Link& link) { return gone(link.a) || gone(link.b); });
    return mesh;
  };
  CHECK(order_of(cut(true, 12)).run_share > 0.98);
  CHECK(order_of(cut(false, 29)).run_share > 0.98);
}

TEST_CASE("nothing to order") {
  CHECK(order_of(Mesh{}).slots() == 0);
  Mesh lone;
  lone.positions.resize(50);
  CHECK(order_of(lone).constraint_slots() == 0);
}

TEST_CASE("triangle meshes") {
  Random random(6);
  for (const double jitter : {0.0, 0.1, 0.2, 0.4}) {
    for (const double removed : {0.0, 0.02, 0.3}) {
      CAPTURE(jitter);
      CAPTURE(removed);
      const Mesh mesh = triangles(40, 45, jitter, removed, random);
      const Ordering ordering = order_of(mesh);
      CHECK(ordering.colours <= 33);
      order_of(shuffled(mesh, random));
    }
  }
}

TEST_CASE("random graphs: colours fit into a word") {
  Random random(7);
  for (std::uint32_t i = 0; i < 20; ++i) {
    CAPTURE(i);
    const std::uint32_t particles = 50 + 100 * i;
    const Mesh mesh = random_graph(particles, 8 * particles, 16, random);
    OrderingOptions options;
    options.tile_particles = 100;
    CHECK(order_of(mesh, options).colours <= 64);
    options.least_run_share = 0;  // as if it were woven
    CHECK(order_of(mesh, options).colours <= 64);
  }
}

TEST_CASE("trees and stars") {
  Random random(8);
  Mesh tree;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    tree.positions.push_back(random.in_box(1));
    if (i > 0) tree.links.push_back({i, (i - 1) / 15, ConstraintKind::distance});
  }
  CHECK(order_of(tree).colours <= 64);
  Mesh star;
  for (std::uint32_t i = 0; i <= 200; ++i) {
    star.positions.push_back(random.in_box(1));
    if (i > 0) star.links.push_back({0, i, ConstraintKind::rope});
  }
  CHECK(order_of(star).colours == 200);
}

TEST_CASE("tiles: an even number, nearly equal, two from 1000 particles on") {
  Random random(9);
  OrderingOptions options;
  options.tile_particles = 300;
  for (const Mesh& mesh : {grid(50, 50), triangles(50, 50, 0.4, 0.1, random), chain(2500)}) {
    const Ordering ordering = order_of(mesh, options);
    CHECK(ordering.tiles.size() == 10);
    for (const Tile& tile : ordering.tiles) {
      const auto first = ordering.particle_at.begin() + tile.first_slot;
      const auto last = ordering.particle_at.begin() + tile.last_slot;
      const auto padding = std::count(first, last, kNoIndex);
      const auto particles = tile.last_slot - tile.first_slot - padding;
      CHECK(particles >= 180);
      CHECK(particles <= 320);
    }
  }
  CHECK(order_of(grid(27, 37)).tiles.size() == 1);
  CHECK(order_of(grid(27, 38)).tiles.size() == 2);
}

TEST_CASE("the same arguments give the same ordering") {
  Random random(10);
  for (const Mesh& mesh : {grid(40, 40), triangles(40, 40, 0.3, 0.1, random)}) {
    CHECK(equal(order_of(mesh), order_of(mesh)));
  }
}

TEST_CASE("particles in one place") {
  Mesh mesh = grid(40, 40);
  for (Vec3& p : mesh.positions) p = {1, 2, 3};
  order_of(mesh);
}

TEST_CASE("a large sheet: long runs in every tile") {
  const Mesh mesh = grid(300, 300);
  const Ordering ordering = order_of(mesh);
  CHECK(ordering.run_share == 1.0);
  CHECK(ordering.colours == 5);
  CHECK(ordering.tiles.size() == 22);
  CHECK(longest_run(ordering) >= 1000);
  CHECK(ordering.runs.size() < 250);
  CHECK(ordering.slots() < 1.05 * 90'000);
}

}  // namespace
}  // namespace weft::test::engine_ordering_ordering
