#include "engine/hypotenuse.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "tests/support/random.h"

namespace weft::test::engine_hypotenuse {
namespace {

TEST_CASE(
    "lengths are right to the last digit or the one before, and nothing leaves the range of "
    "numbers") {
  CHECK(hypotenuse(3, 4) == 5);
  CHECK(hypotenuse(2, 3, 6) == 7);
  CHECK(hypotenuse(0, 0) == 0);
  CHECK(hypotenuse(-3e200, 4e200) == doctest::Approx(5e200).epsilon(1e-15));
  CHECK(hypotenuse(3e-200, 0, -4e-200) == doctest::Approx(5e-200).epsilon(1e-15));
  CHECK(hypotenuse(1, -std::numeric_limits<double>::infinity()) ==
        std::numeric_limits<double>::infinity());
}

TEST_CASE(
    "of three numbers it has the bits of std::hypot in libstdc++, which golden hashes are made "
    "with") {
  Random random(1);
  for (int i = 0; i < 10'000; ++i) {
    const double x = random.between(-1, 1), y = random.between(-1, 1),
                 z = random.between(-1e-3, 1e-3);
    const auto exact = std::sqrt(static_cast<long double>(x) * x + static_cast<long double>(y) * y +
                                 static_cast<long double>(z) * z);
    REQUIRE(std::abs(hypotenuse(x, y, z) / static_cast<double>(exact) - 1) < 5e-16);
#ifdef __GLIBCXX__
    REQUIRE(hypotenuse(x, y, z) == std::hypot(x, y, z));
#endif
  }
}

}  // namespace
}  // namespace weft::test::engine_hypotenuse
