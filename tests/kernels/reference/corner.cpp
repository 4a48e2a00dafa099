/// Pushes out of the sides of a hollow, one after the other.
#include "kernels/reference/corner.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "tests/support/random.h"

namespace weft::test::kernels_reference_corner {
namespace {

using kernels::Vector;

Vector random_direction(Random& random) {
  const Vector v{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
  return (1 / length(v)) * v;
}

/// Normals of so many sides, each of which is pressed by pushes out of the others.
std::vector<Vector> sides(int count, Random& random) {
  std::vector<Vector> normals;
  while (static_cast<int>(normals.size()) < count) {
    const Vector next = random_direction(random);
    bool is_good = true;
    for (const Vector n : normals) is_good = is_good && dot(n, next) < -0.05 && dot(n, next) > -0.9;
    if (is_good) normals.push_back(next);
    if (normals.size() == 2 && random.below(50) == 0) normals.clear();  // there may be no third
  }
  return normals;
}

TEST_CASE("pushes out of two and three sides of a hollow end on all of them") {
  Random random(1);
  for (const int count : {2, 3}) {
    for (int trial = 0; trial < 300; ++trial) {
      const std::vector<Vector> normals = sides(count, random);
      reference::Corner corner;
      Vector x = 0.1 * random_direction(random), forces{};
      double sum = 0;
      for (const Vector n : normals) {
        const auto push = corner.add(n);
        CHECK(length(push.along) == doctest::Approx(1));
        CHECK(push.sine == doctest::Approx(dot(push.along, n)));
        const double way = -dot(x, n) / push.sine;
        x = x + way * push.along;
        forces = forces + way * push.along;
        sum += way * push.forces;
        CHECK(length(corner.free_part(push.along)) < 1e-12);
      }
      for (const Vector n : normals) CHECK(std::abs(dot(x, n)) < 1e-12);
      // The same sum of pushes out of the sides, by Cramer's rule.
      if (count < 3) continue;
      const Vector &a = normals[0], &b = normals[1], &c = normals[2];
      const double det = dot(a, cross(b, c));
      const double all =
          (dot(forces, cross(b, c)) + dot(a, cross(forces, c)) + dot(a, cross(b, forces))) / det;
      CHECK(sum == doctest::Approx(all).epsilon(1e-9));
    }
  }
}

TEST_CASE("no push is a pull to another side: its forces are at least those of one side") {
  Random random(2);
  for (int trial = 0; trial < 2000; ++trial) {
    reference::Corner corner;
    for (int i = 0; i < 6; ++i) {
      const Vector n = random_direction(random);
      const auto push = corner.add(n);
      CHECK(push.forces >= 1 - 1e-12);
      CHECK(push.sine > 0);
      CHECK(dot(push.along, n) == doctest::Approx(push.sine).epsilon(1e-6));
    }
  }
}

TEST_CASE("sides that a push leads away from, or that are opposite, do not hold") {
  reference::Corner corner;
  const Vector up{0, 1, 0}, aside{std::sqrt(0.5), std::sqrt(0.5), 0}, down{0, -1, 0};
  corner.add(up);
  CHECK(corner.add(aside).along == aside);
  corner = {};
  corner.add(up);
  CHECK(corner.add(down).along == down);
}

}  // namespace
}  // namespace weft::test::kernels_reference_corner
