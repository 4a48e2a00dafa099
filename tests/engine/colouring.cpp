#include "engine/colouring.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/random.h"

namespace weft::test {
namespace {

std::vector<std::uint32_t> degrees(const std::vector<Pair>& pairs, std::size_t particles) {
  std::vector<std::uint32_t> degree(particles);
  for (const Pair& pair : pairs) {
    ++degree[pair.a];
    ++degree[pair.b];
  }
  return degree;
}

/// No particle twice in a colour, colours from 0 without a gap, and never more than a greedy choice
/// may need.
void check_colouring(const std::vector<Pair>& pairs, std::size_t particles) {
  const Colouring colouring = colour_pairs(pairs, particles);
  REQUIRE(colouring.colour.size() == pairs.size());
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  std::set<std::uint32_t> colours;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::uint32_t colour = colouring.colour[i];
    colours.insert(colour);
    REQUIRE(seen.insert({pairs[i].a, colour}).second);
    REQUIRE(seen.insert({pairs[i].b, colour}).second);
  }
  CHECK(colours.size() == colouring.count);
  if (!colours.empty()) CHECK(*colours.rbegin() + 1 == colouring.count);
  const std::vector<std::uint32_t> degree = degrees(pairs, particles);
  std::uint32_t bound = 0;
  for (const Pair& pair : pairs) bound = std::max(bound, degree[pair.a] + degree[pair.b] - 1);
  CHECK(colouring.count <= bound);
}

std::vector<Pair> random_pairs(std::uint32_t particles, std::size_t count, std::uint32_t seed) {
  Random random(seed);
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
  while (pairs.size() < count) {
    const std::uint32_t a = random.below(particles);
    const std::uint32_t b = random.below(particles);
    if (a != b) pairs.insert({std::min(a, b), std::max(a, b)});
  }
  std::vector<Pair> out;
  for (const auto& [a, b] : pairs) out.push_back({a, b});
  return out;
}

TEST_CASE("random graphs are coloured properly") {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    check_colouring(random_pairs(40, 30 + 20 * seed, seed), 40);
  }
}

TEST_CASE("hubs are coloured properly, each of their constraints in a colour of its own") {
  for (const std::uint32_t spokes : {63u, 64u, 65u, 1000u}) {
    CAPTURE(spokes);
    std::vector<Pair> pairs = random_pairs(spokes, 3 * spokes, spokes);
    for (std::uint32_t k = 0; k < spokes; ++k) pairs.push_back({k, spokes});
    check_colouring(pairs, spokes + 1);
    CHECK(colour_pairs(pairs, spokes + 1).count >= spokes);
  }
}

TEST_CASE("nothing to colour takes no colour") { check_colouring({}, 5); }

TEST_CASE("grids take four colours and chains two") {
  CHECK(describe(*model_of(scene_of("corners", 21))).colours == 4);
  CHECK(describe(*model_of(scene_of("hang", 20))).colours == 4);
  CHECK(describe(*model_of(scene_of("chain", 20))).colours == 2);
}

}  // namespace
}  // namespace weft::test
