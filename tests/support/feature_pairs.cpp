#include "tests/support/feature_pairs.h"

#include <algorithm>
#include <cmath>

#include "tests/support/random.h"

namespace weft::test {
namespace {

using kernels::Vector;

Vector draw(Random& random, double size) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

Vector between(Vector a, Vector b, double share) { return a + share * (b - a); }

double to_segment(Vector p, Vector a, Vector b) {
  const Vector d = b - a;
  const double square = dot(d, d);
  const double at = square > 0 ? std::clamp(dot(p - a, d) / square, 0.0, 1.0) : 0;
  return length(p - between(a, b, at));
}

/// To the plane of a triangle where p is above the inside; else far.
double to_inside(Vector p, Vector a, Vector b, Vector c) {
  constexpr double kFar = 1e300;
  const Vector n = cross(b - a, c - a);
  const double square = dot(n, n);
  if (!(square > 0)) return kFar;
  const auto is_left = [&](Vector from, Vector to) {
    return dot(cross(to - from, p - from), n) >= 0;
  };
  if (!is_left(a, b) || !is_left(b, c) || !is_left(c, a)) return kFar;
  return std::abs(dot(p - a, n)) / std::sqrt(square);
}

double of_edges(Vector a, Vector b, Vector c, Vector d) {
  const double ends = std::min(
      {to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
  const Vector n = cross(b - a, d - c);
  const double square = dot(n, n);
  if (!(square > 0)) return ends;
  // Each edge crosses the plane through the other one and n.
  const auto crosses = [&](Vector p, Vector q, Vector from, Vector to) {
    const Vector across = cross(n, to - from);
    return (dot(across, p - from) > 0) != (dot(across, q - from) > 0);
  };
  if (!crosses(a, b, c, d) || !crosses(c, d, a, b)) return ends;
  return std::min(ends, std::abs(dot(a - c, n)) / std::sqrt(square));
}

void degenerate_triangle(FeaturePair& pair, Random& random) {
  auto& [p, a, b, c] = pair.point;
  switch (pair.form) {
    case Form::usual:
      break;
    case Form::touching:
      p = between(between(a, b, random.between(-0.2, 1.2)), c, random.between(-0.2, 1.2)) +
          draw(random, 1e-3);
      break;
    case Form::needle:
      c = between(a, b, random.between(-0.5, 1.5)) +
          draw(random, std::pow(10, random.between(-7, -2)));
      break;
    case Form::flat:
      c = between(a, b, random.between(-0.5, 1.5));
      break;
    case Form::lost:
      c = random.below(2) == 0 ? a : b;
      if (random.below(2) == 0) b = a;
      break;
    case Form::met:
      p = random.below(2) == 0
              ? pair.point[1 + random.below(3)]
              : between(between(a, b, random.between(0, 1)), c, random.between(0, 1));
      break;
  }
}

void degenerate_edges(FeaturePair& pair, Random& random) {
  auto& [a, b, c, d] = pair.point;
  switch (pair.form) {
    case Form::usual:
      break;
    case Form::touching: {
      const Vector on_cloth = between(a, b, random.between(-0.2, 1.2));
      const Vector by = on_cloth - between(c, d, random.between(-0.2, 1.2)) + draw(random, 1e-3);
      c = c + by;
      d = d + by;
      break;
    }
    case Form::needle:
      d = c + random.between(-1, 1) * (b - a) + draw(random, std::pow(10, random.between(-7, -2)));
      break;
    case Form::flat:
      d = c + random.between(-1, 1) * (b - a);
      if (random.below(3) == 0) {
        const Vector by = between(a, b, random.between(-1, 2)) - c;
        c = c + by;
        d = d + by;
      }
      break;
    case Form::lost:
      d = c;
      if (random.below(2) == 0) b = a;
      break;
    case Form::met: {
      if (random.below(2) == 0) {
        c = random.below(2) == 0 ? a : b;
        break;
      }
      const Vector by = between(a, b, random.between(0, 1)) - between(c, d, random.between(0, 1));
      c = c + by;
      d = d + by;
      break;
    }
  }
}

}  // namespace

std::string text(Form form) {
  constexpr std::array<const char*, kForms.size()> kNames{"usual", "touching", "needle",
                                                          "flat",  "lost",     "met"};
  return kNames[static_cast<std::size_t>(form)];
}

FeaturePair feature_pair(bool edges, Form form, std::uint32_t seed) {
  Random random(seed);
  FeaturePair pair{.edges = edges, .form = form, .seed = seed};
  for (Vector& p : pair.point) p = draw(random, 1);
  if (edges)
    degenerate_edges(pair, random);
  else
    degenerate_triangle(pair, random);
  return pair;
}

double distance_of(const FeaturePair& pair) {
  const auto& [a, b, c, d] = pair.point;
  if (pair.edges) return of_edges(a, b, c, d);
  return std::min(
      {to_segment(a, b, c), to_segment(a, c, d), to_segment(a, d, b), to_inside(a, b, c, d)});
}

}  // namespace weft::test
