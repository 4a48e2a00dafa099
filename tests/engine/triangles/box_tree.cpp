/// Trees of boxes against all boxes, one by one.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "engine/triangles/box_tree.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"

namespace weft::test::engine_triangles_box_tree {
namespace {

/// Some of them are points, some meet others at a face.
std::vector<Box> random_boxes(std::uint32_t count, Random& random) {
  std::vector<Box> boxes;
  for (std::uint32_t i = 0; i < count; ++i) {
    Box box;
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = static_cast<float>(random.below(100)) / 4;
      box.high[k] = box.low[k] + static_cast<float>(random.below(9)) / 4;
    }
    boxes.push_back(box);
  }
  return boxes;
}

bool meet(const Box& a, const Box& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (a.low[k] > b.high[k] || b.low[k] > a.high[k]) return false;
  }
  return true;
}

struct Grown {
  std::vector<Box> boxes;
  BoxTree tree;

  Grown(std::uint32_t count, Random& random) : boxes(random_boxes(count, random)) {
    const std::vector<std::uint32_t> order = random.permutation(count);
    tree = BoxTree(order);
    refit();
  }
  void refit() {
    tree.refit([&](std::uint32_t i) { return boxes[i]; });
  }
};

// One cluster holds 16; some counts leave leaves empty.
constexpr std::array kCounts{0u, 1u, 2u, 15u, 16u, 17u, 33u, 48u, 64u, 65u, 200u, 1000u};

void check_find(const simd::Table& table, const Grown& grown, const Box& box) {
  std::vector<std::uint32_t> found, known;
  grown.tree.find(table, box, [&](std::uint32_t i) { found.push_back(i); });
  for (std::uint32_t i = 0; i < grown.boxes.size(); ++i) {
    if (meet(grown.boxes[i], box)) known.push_back(i);
  }
  std::ranges::sort(found);
  CHECK(found == known);
}

void check_meet(const simd::Table& table, const Grown& a, const Grown& b) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found, known;
  BoxTree::meet(table, a.tree, b.tree, [&](std::uint32_t i, std::uint32_t j) {
    found.push_back({i, j});
  });
  for (std::uint32_t i = 0; i < a.boxes.size(); ++i) {
    for (std::uint32_t j = 0; j < b.boxes.size(); ++j) {
      if (meet(a.boxes[i], b.boxes[j])) known.push_back({i, j});
    }
  }
  std::ranges::sort(found);
  CHECK(found == known);
}

float square_to(const Box& box, const std::array<float, 3>& point) {
  float square = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const float beyond = std::max({box.low[k] - point[k], point[k] - box.high[k], 0.f});
    square += beyond * beyond;
  }
  return square;
}

/// Of the box that is nearest.
void check_near(const Grown& grown, const std::array<float, 3>& point, std::size_t& visits) {
  float least = std::numeric_limits<float>::max(), known = least;
  std::uint32_t nearest = 0;
  grown.tree.near(point, [&](std::uint32_t i) {
    ++visits;
    if (square_to(grown.boxes[i], point) < least) {
      least = square_to(grown.boxes[i], point);
      nearest = i;
    }
    return least;
  });
  for (const Box& box : grown.boxes) known = std::min(known, square_to(box, point));
  CHECK(least == known);
  if (!grown.boxes.empty()) CHECK(square_to(grown.boxes[nearest], point) == known);
}

TEST_CASE("trees find all boxes that meet, once each, after they have moved too") {
  for (const simd::Isa isa : supported_isas()) {
    const simd::Table& table = simd::table(isa);
    Random random(4);
    for (const std::uint32_t count : kCounts) {
      CAPTURE(count);
      Grown grown(count, random);
      for (int round = 0; round < 2; ++round) {
        for (const Box& box : random_boxes(20, random)) check_find(table, grown, box);
        check_find(table, grown, {{-1, -1, -1}, {100, 100, 100}});
        check_find(table, grown, {{-3, -3, -3}, {-2, -2, -2}});
        for (const std::uint32_t others : kCounts) check_meet(table, grown, Grown(others, random));
        grown.boxes = random_boxes(count, random);
        grown.refit();
      }
    }
  }
}

TEST_CASE("a tree finds the nearest box, and passes most of them over") {
  Random random(5);
  for (const std::uint32_t count : kCounts) {
    CAPTURE(count);
    const Grown grown(count, random);
    for (int i = 0; i < 50; ++i) {
      std::size_t visits = 0;
      const auto at = [&] { return static_cast<float>(random.between(-5, 30)); };
      check_near(grown, {at(), at(), at()}, visits);
    }
  }
  // In order: most are passed over.
  std::vector<std::uint32_t> order(1024);
  for (std::uint32_t i = 0; i < 1024; ++i) order[i] = i;
  BoxTree line(order);
  line.refit([](std::uint32_t i) {
    const auto x = static_cast<float>(i);
    return Box{{x, 0, 0}, {x + 0.5f, 1, 1}};
  });
  std::size_t visits = 0;
  float least = std::numeric_limits<float>::max();
  line.near({300.2f, 0.5f, 0.5f}, [&](std::uint32_t i) {
    ++visits;
    const auto x = static_cast<float>(i);
    least = std::min(least, square_to({{x, 0, 0}, {x + 0.5f, 1, 1}}, {300.2f, 0.5f, 0.5f}));
    return least;
  });
  CHECK(least == 0);
  CHECK(visits <= 32);
}

TEST_CASE("the bounds of a tree hold its boxes, and no more") {
  Random random(6);
  for (const std::uint32_t count : kCounts) {
    if (count == 0) continue;
    const Grown grown(count, random);
    Box all = grown.boxes[0];
    for (const Box& box : grown.boxes) all.add(box);
    CHECK(grown.tree.box().low == all.low);
    CHECK(grown.tree.box().high == all.high);
    CHECK(grown.tree.box().holds(grown.boxes[count / 2]));
  }
}

}  // namespace
}  // namespace weft::test::engine_triangles_box_tree
