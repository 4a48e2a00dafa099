/// Multipliers of contacts by the keys of their pairs, against a map.
#include "engine/contact/known_multipliers.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <map>

#include "tests/support/random.h"

namespace weft::test::engine_known_multipliers {
namespace {

std::uint64_t random_key(Random& random) {
  const auto half = [&] { return std::uint64_t{random.below(1u << 16)}; };
  // Points beside triangles, and edges, whose keys have the highest bit (Pair::key).
  return half() << 63 | half() << 32 | half();
}

TEST_CASE("multipliers are found by their keys, and others are not known") {
  Random random(1);
  KnownMultipliers known;
  for (const std::uint32_t count : {0u, 1u, 2u, 31u, 1000u, 3u}) {
    CAPTURE(count);
    std::map<std::uint64_t, float> expected;
    known.begin();
    while (expected.size() < count) {
      const std::uint64_t key = random_key(random);
      const auto push = static_cast<float>(random.between(0, 1));
      if (expected.emplace(key, push).second) known.add(key, {push});
    }
    known.end();
    CHECK(known.all().size() == count);
    for (const auto& [key, push] : expected) {
      REQUIRE(known.find(key) != nullptr);
      CHECK((*known.find(key))[0] == push);
    }
    for (int i = 0; i < 1000; ++i) {
      const std::uint64_t key = random_key(random);
      CHECK((known.find(key) != nullptr) == expected.contains(key));
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_known_multipliers
