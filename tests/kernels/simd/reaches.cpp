/// Features of two triangles that may meet while their corners are in their tubes, on every
/// instruction set: against the directions in double, and against features that do meet.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/contact/tube.h"
#include "kernels/simd/table.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"

namespace weft::test::kernels_simd_reaches {
namespace {

using kernels::kLanes;
using kernels::Vector;

Vector draw(Random& random, double size) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}
Box box_at(Vector middle, double half) {
  const auto at = [&](double x, double by) { return static_cast<float>(x + by); };
  return {{at(middle.x, -half), at(middle.y, -half), at(middle.z, -half)},
          {at(middle.x, half), at(middle.y, half), at(middle.z, half)}};
}

/// A triangle that is first, and others near to it, whose corners go some way.
struct Triangles {
  static constexpr std::size_t kOthers = 11;
  std::vector<Tube> tubes;  // those of the first, then of each other
  kernels::AlignedVector<simd::PointTube> lanes;
  std::array<std::uint32_t[3], kOthers> corners{};
  simd::ReachAxes axes;
  std::array<Vector, 7> directions{};

  explicit Triangles(std::uint32_t seed) {
    Random random(seed);
    const double size = std::pow(10, random.between(-3, 0));
    const Vector origin = draw(random, seed % 3 == 0 ? 5 : 0);
    const double thick = 0.1 * size * random.between(0, 1);
    std::array<Vector, 3> first;
    for (std::uint32_t t = 0; t < 1 + kOthers; ++t) {
      const Vector place = origin + (t > 0 ? draw(random, size) : Vector{});
      const Vector way = draw(random, size);
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector x = place + draw(random, size);
        if (t == 0) first[k] = x;
        tubes.push_back({box_at(x, thick), box_at(x + way + draw(random, 0.2 * size), thick)});
        if (t > 0) corners[t - 1][k] = static_cast<std::uint32_t>(tubes.size() - 1);
      }
    }
    for (const Tube& tube : tubes) lanes.push_back(tube.in_lanes());
    const Vector n = cross(first[1] - first[0], first[2] - first[0]);
    directions = {Vector{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, n};
    for (std::size_t k = 0; k < 3; ++k) directions[4 + k] = cross(n, first[(k + 1) % 3] - first[k]);
    for (std::size_t i = 0; i < 4; ++i) {
      Vector& d = directions[3 + i];
      d = kernels::direction(d, length(d));
      for (const std::size_t lane : {4 + i, 12 + i}) {
        axes.x[lane] = static_cast<float>(d.x);
        axes.y[lane] = static_cast<float>(d.y);
        axes.z[lane] = static_cast<float>(d.z);
      }
    }
  }
  std::array<std::uint16_t, kOthers> meet(const simd::Table& table,
                                          std::uint16_t wanted = 0xffff) const {
    simd::TriangleReaches reaches;
    const simd::PointTube* const first[] = {&lanes[0], &lanes[1], &lanes[2]};
    table.reaches_of_triangle(axes, first, reaches);
    std::array<std::uint16_t, kOthers> met;
    met.fill(0xffff);
    std::array<std::uint16_t, kOthers> wanted_of_each;
    wanted_of_each.fill(wanted);
    table.meet_triangles({.axes = &axes,
                          .reaches = &reaches,
                          .tubes = lanes.data(),
                          .corners = corners.data(),
                          .wanted = wanted_of_each.data(),
                          .met = met.data()},
                         kOthers);
    return met;
  }
  /// m, by which a direction keeps points of both apart, at most: at both ends on one side.
  double apart(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) const {
    double most = -1e30;
    for (const Vector d : directions) {
      double beyond = 1e30, before = 1e30;
      for (Box Tube::*end : {&Tube::begins, &Tube::ends}) {
        const auto [low_a, high_a] = range(a, end, d);
        const auto [low_b, high_b] = range(b, end, d);
        beyond = std::min(beyond, low_a - high_b);
        before = std::min(before, low_b - high_a);
      }
      most = std::max({most, beyond, before});
    }
    return most;
  }
  std::array<double, 2> range(const std::vector<std::uint32_t>& points, Box Tube::*end,
                              Vector d) const {
    double low = 1e30, high = -1e30;
    for (const std::uint32_t point : points) {
      const Box& box = tubes[point].*end;
      for (int corner = 0; corner < 8; ++corner) {
        const auto at = [&](std::size_t k) {
          return static_cast<double>((corner >> k & 1) != 0 ? box.high[k] : box.low[k]);
        };
        const double height = dot(d, Vector{at(0), at(1), at(2)});
        low = std::min(low, height);
        high = std::max(high, height);
      }
    }
    return {low, high};
  }
};

/// Of a bit of simd::TriangleMeeting: points of the first triangle, and of the other one.
std::array<std::vector<std::uint32_t>, 2> features(std::uint32_t bit,
                                                   const std::uint32_t (&other)[3]) {
  const std::vector<std::uint32_t> first{0, 1, 2}, second{other[0], other[1], other[2]};
  if (bit == 0) return {first, second};
  if (bit < 4) return {std::vector{bit - 1}, second};
  if (bit < 7) return {first, std::vector{other[bit - 4]}};
  const std::uint32_t i = (bit - 7) % 3, j = (bit - 7) / 3;
  return {std::vector{i, (i + 1) % 3}, std::vector{other[j], other[(j + 1) % 3]}};
}

TEST_CASE("features meet unless a direction keeps their tubes apart, on each instruction set") {
  int met = 0, apart = 0;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    const Triangles triangles(seed);
    const auto found = triangles.meet(simd::table(supported_isas().front()));
    for (const simd::Isa isa : supported_isas()) CHECK(triangles.meet(simd::table(isa)) == found);
    const auto wanted = static_cast<std::uint16_t>(seed * 40503);
    const auto some = triangles.meet(simd::table(supported_isas().front()), wanted);
    for (std::size_t t = 0; t < Triangles::kOthers; ++t) {
      CHECK(some[t] == (found[t] & (wanted | 1)));
      const bool is_whole = (found[t] & 1) != 0;
      if (!is_whole) CHECK(found[t] == 0);
      for (std::uint32_t bit = 0; bit < 16; ++bit) {
        CAPTURE(bit);
        const auto [a, b] = features(bit, triangles.corners[t]);
        const double by = triangles.apart(a, b), rounding = 3e-5;
        const bool meets = (found[t] >> bit & 1) != 0;
        if (by > rounding) CHECK_FALSE(meets);
        if (by < 0 && is_whole) CHECK(meets);
        ++(meets ? met : apart);
      }
    }
  }
  CHECK(met > 5000);
  CHECK(apart > 5000);
}

/// Somewhere in its tube when so much of its time is over.
Vector somewhere(const Tube& tube, double share, Random& random) {
  const auto at = [&](std::size_t k) {
    const auto in = [&](const Box& box) {
      return random.between(static_cast<double>(box.low[k]), static_cast<double>(box.high[k]));
    };
    return (1 - share) * in(tube.begins) + share * in(tube.ends);
  };
  return {at(0), at(1), at(2)};
}
Vector in_feature(const Triangles& triangles, const std::vector<std::uint32_t>& points,
                  double share, Random& random) {
  Vector sum{};
  double weights = 0;
  for (const std::uint32_t point : points) {
    const double w = random.between(0, 1);
    sum = sum + w * somewhere(triangles.tubes[point], share, random);
    weights += w;
  }
  return (1 / weights) * sum;
}

TEST_CASE("features that meet on their way are found, however their points go") {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    Random random(1000 + seed);
    Triangles triangles(seed);
    // Another triangle is moved so that one of its features meets one of the first.
    const std::uint32_t bit = 1 + random.below(15);
    const std::size_t t = random.below(Triangles::kOthers);
    CAPTURE(bit);
    const auto [a, b] = features(bit, triangles.corners[t]);
    const double share = random.between(0, 1);
    const Vector by =
        in_feature(triangles, a, share, random) - in_feature(triangles, b, share, random);
    for (const std::uint32_t point : triangles.corners[t]) {
      Tube& tube = triangles.tubes[point];
      const auto moved = [&](const Box& box) {
        Box there = box;
        const double way[] = {by.x, by.y, by.z};
        for (std::size_t k = 0; k < 3; ++k) {
          there.low[k] = static_cast<float>(static_cast<double>(box.low[k]) + way[k] - 1e-6);
          there.high[k] = static_cast<float>(static_cast<double>(box.high[k]) + way[k] + 1e-6);
        }
        return there;
      };
      tube = {moved(tube.begins), moved(tube.ends)};
      triangles.lanes[point] = tube.in_lanes();
    }
    for (const simd::Isa isa : supported_isas())
      CHECK((triangles.meet(simd::table(isa))[t] & (1u << bit | 1u)) == (1u << bit | 1u));
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_reaches
