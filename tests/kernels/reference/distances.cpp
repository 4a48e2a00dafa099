/// Where two features are nearest to each other, against what is known without telling cases apart:
/// the least of all distances of their parts, and of many of their points.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/reference/distances.h"
#include "tests/support/feature_pairs.h"

namespace weft::test::kernels_reference_distances {
namespace {

using kernels::Vector;

Vector sum_of(const reference::Nearest& nearest, const FeaturePair& pair) {
  Vector sum{};
  for (std::size_t k = 0; k < 4; ++k) sum = sum + nearest.weight[k] * pair.point[k];
  return sum;
}

double size_of(const FeaturePair& pair) {
  double most = 0;
  for (const Vector p : pair.point) most = std::max(most, length(p));
  return most;
}

/// Of a grid of points of both features.
double least_of_samples(const FeaturePair& pair) {
  constexpr int kParts = 40;
  const auto& [a, b, c, d] = pair.point;
  double least = 1e300;
  for (int i = 0; i <= kParts; ++i) {
    for (int j = 0; j <= kParts - (pair.edges ? 0 : i); ++j) {
      const double s = double{1} * i / kParts, t = double{1} * j / kParts;
      const Vector r =
          pair.edges ? a + s * (b - a) - (c + t * (d - c)) : a - (b + s * (c - b) + t * (d - b));
      least = std::min(least, length(r));
    }
  }
  return least;
}

void check(const FeaturePair& pair) {
  const auto& [a, b, c, d] = pair.point;
  const reference::Nearest found = pair.edges ? reference::nearest_of_edges(a, b, c, d)
                                              : reference::nearest_in_triangle(a, b, c, d);
  const double size = size_of(pair), rounding = 1e-9 * size;
  CAPTURE(pair.edges);
  CAPTURE(text(pair.form));
  CAPTURE(pair.seed);
  CHECK(length(sum_of(found, pair) - found.r) <= rounding);
  const auto& w = found.weight;
  if (pair.edges) {
    for (const double x : w) CHECK(std::abs(x) <= 1);
    CHECK(w[0] + w[1] == doctest::Approx(1));
    CHECK(w[2] + w[3] == doctest::Approx(-1));
    CHECK(std::min({w[0], w[1], -w[2], -w[3]}) >= 0);
  } else {
    CHECK(w[0] == 1);
    CHECK(w[1] + w[2] + w[3] == doctest::Approx(-1));
    CHECK(std::max({w[1], w[2], w[3]}) <= 1e-12);
  }
  // Edges that are all but parallel are nearest where they are parallel: within 1e-7 of their way.
  const double known = distance_of(pair), left = pair.edges ? 1e-6 * size : rounding;
  CHECK(length(found.r) <= known + left);
  CHECK(length(found.r) >= known - rounding);
  CHECK(length(found.r) <= least_of_samples(pair) + left);
}

TEST_CASE("features are nearest where no other points of theirs are nearer") {
  for (const bool edges : {false, true}) {
    for (const Form form : kForms) {
      for (std::uint32_t seed = 1; seed <= 300; ++seed) check(feature_pair(edges, form, seed));
    }
  }
}

TEST_CASE("weights name the part of a feature that is nearest") {
  const Vector a{0, 0, 0}, b{2, 0, 0}, c{0, 2, 0};
  const auto corners = [&](double x, double y) {
    return reference::corners_of(reference::nearest_in_triangle({x, y, 0.5}, a, b, c));
  };
  CHECK(corners(0.5, 0.5) == 7);
  CHECK(corners(-1, -1) == 1);
  CHECK(corners(3, -1) == 2);
  CHECK(corners(-1, 3) == 4);
  CHECK(corners(1, -1) == 3);
  CHECK(corners(2, 2) == 6);
  CHECK(corners(-1, 1) == 5);
  CHECK(is_within_edges(reference::nearest_of_edges(a, b, {1, -1, 1}, {1, 1, 1})));
  CHECK_FALSE(is_within_edges(reference::nearest_of_edges(a, b, {1, 1, 1}, {1, 2, 1})));
  CHECK_FALSE(is_within_edges(reference::nearest_of_edges(a, b, {3, -1, 1}, {3, 1, 1})));
}

}  // namespace
}  // namespace weft::test::kernels_reference_distances
