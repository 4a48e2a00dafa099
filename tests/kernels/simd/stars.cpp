/// Stars that fold, on every instruction set, against the directions of their triangles in double;
/// and what a star that does not fold promises: projected to a plane it is no fold at any time.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/simd/contact_data.h"
#include "kernels/simd/table.h"
#include "kernels/vectors.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"

namespace weft::test::kernels_simd_stars {
namespace {

using kernels::kLanes;
using kernels::Vector;

constexpr std::size_t kStars = kLanes + 3;  // two blocks, of which one is not full

/// Stars of three to nine triangles each, whose points move.
struct Stars {
  kernels::AlignedVector<float> starts, ways;  // quads
  std::vector<std::array<std::uint32_t, 3>> corners;
  std::vector<float> least;
  std::vector<std::vector<std::uint32_t>> triangles;  // per star

  explicit Stars(std::uint32_t seed) {
    Random random(seed);
    for (std::size_t star = 0; star < kStars; ++star) add_star(random);
  }
  Vector draw(Random& random, double size) const {
    return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
  }
  std::uint32_t add_point(Vector x, Vector way) {
    for (const double value : {x.x, x.y, x.z, 0.}) starts.push_back(static_cast<float>(value));
    for (const double value : {way.x, way.y, way.z, 0.}) ways.push_back(static_cast<float>(value));
    return static_cast<std::uint32_t>(starts.size() / 4 - 1);
  }
  void add_star(Random& random) {
    const std::uint32_t count = 3 + random.below(7);
    const double bend = random.between(0, 1), speed = random.between(0, 0.8);
    const Vector common = draw(random, 2);
    const std::uint32_t centre = add_point(draw(random, 0.3), common);
    triangles.emplace_back();
    for (std::uint32_t k = 0; k < count; ++k) {
      const double angle = 2 * 3.14159265358979 * k / count;
      const Vector out{std::cos(angle), bend * random.between(-1, 1), -std::sin(angle)};
      add_point(out, common + draw(random, speed));
    }
    for (std::uint32_t k = 0; k < count; ++k) {
      triangles.back().push_back(static_cast<std::uint32_t>(corners.size()));
      corners.push_back({centre, centre + 1 + k, centre + 1 + (k + 1) % count});
      least.push_back(static_cast<float>(random.between(0, 0.3)));
    }
  }
  static Vector at(const kernels::AlignedVector<float>& quads, std::uint32_t point) {
    return {static_cast<double>(quads[4 * point]), static_cast<double>(quads[4 * point + 1]),
            static_cast<double>(quads[4 * point + 2])};
  }
  /// m^2, when so much of the time is over.
  Vector area(std::uint32_t triangle, double share) const {
    const auto x = [&](std::size_t k) {
      const std::uint32_t point = corners[triangle][k];
      return at(starts, point) + share * at(ways, point);
    };
    return cross(x(1) - x(0), x(2) - x(0));
  }
  Vector direction(std::size_t star) const {
    Vector sum{};
    for (const std::uint32_t t : triangles[star]) sum = sum + area(t, 0) + area(t, 1);
    return (1 / length(sum)) * sum;
  }
  std::vector<std::uint16_t> folded(const simd::Table& table) const {
    std::vector<std::array<std::uint32_t, kLanes>> rows;
    std::vector<simd::StarBlock> blocks;
    for (std::size_t first = 0; first < kStars; first += kLanes) {
      simd::StarBlock block{static_cast<std::uint32_t>(rows.size()), 0};
      for (std::size_t i = 0; i < 9; ++i) {
        rows.emplace_back();
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
          const auto& of = triangles[std::min(first + lane, kStars - 1)];
          // A star with fewer triangles has each of them as often as it can.
          rows.back()[lane] = 4 * of[i % of.size()];
        }
      }
      block.last = static_cast<std::uint32_t>(rows.size());
      blocks.push_back(block);
    }
    kernels::AlignedVector<simd::TriangleTurn> turns(corners.size());
    const simd::TriangleTurns turning{
        .corners = reinterpret_cast<const std::uint32_t(*)[3]>(corners.data()),
        .least_area = least.data(),
        .starts = starts.data(),
        .ways = ways.data(),
        .turns = turns.data()};
    // In parts, as threads do.
    table.contacts->turn_triangles(turning, 0, 5);
    table.contacts->turn_triangles(turning, 5, corners.size());
    std::vector<std::uint16_t> folded(blocks.size());
    const simd::StarFold fold{.blocks = blocks.data(),
                              .rows = reinterpret_cast<const std::uint32_t(*)[kLanes]>(rows.data()),
                              .turns = turns.data(),
                              .folded = folded.data()};
    table.contacts->find_folded_stars(fold, 0, blocks.size());
    return folded;
  }
};

TEST_CASE(
    "stars that fold are found alike on each instruction set, and no triangle of others turns") {
  int folded = 0, smooth = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    const Stars stars(seed);
    const auto found = stars.folded(simd::table(supported_isas().front()));
    for (const simd::Isa isa : supported_isas()) CHECK(stars.folded(simd::table(isa)) == found);
    for (std::size_t star = 0; star < kStars; ++star) {
      CAPTURE(star);
      const bool folds = (found[star / kLanes] >> star % kLanes & 1) != 0;
      ++(folds ? folded : smooth);
      if (folds || 9 % stars.triangles[star].size() != 0) continue;  // the same direction as below
      const Vector n = stars.direction(star);
      for (const std::uint32_t t : stars.triangles[star]) {
        for (int k = 0; k <= 20; ++k)
          CHECK(dot(stars.area(t, 0.05 * k), n) > static_cast<double>(stars.least[t]) - 1e-4);
      }
    }
  }
  CHECK(folded > 200);
  CHECK(smooth > 200);
}

TEST_CASE("a star that turns as a whole does not fold, one that closes like a book does") {
  for (const double angle : {0.5, 3.0}) {
    CAPTURE(angle);
    Stars stars(1);
    stars.least.assign(stars.least.size(), 1e-3f);
    for (std::uint32_t point = 0; point < stars.starts.size() / 4; ++point) {
      // The half with x > 0 turns about z, or by the small angle all of it does.
      const Vector x = Stars::at(stars.starts, point);
      const bool turns = angle < 1 || x.x > 0.5;
      const double a = turns ? angle : 0, c = std::cos(a), s = std::sin(a);
      const Vector to{c * x.x - s * x.y, s * x.x + c * x.y, x.z};
      const Vector flat{x.x, 0, x.z}, way = to - x;
      for (std::size_t k = 0; k < 3; ++k) {
        const double at[] = {flat.x, flat.y, flat.z}, by[] = {way.x, way.y, way.z};
        stars.starts[4 * point + k] = static_cast<float>(at[k]);
        stars.ways[4 * point + k] = static_cast<float>(by[k]);
      }
    }
    // The first star of six triangles.
    const auto star =
        static_cast<std::size_t>(std::ranges::find(stars.triangles, std::size_t{6},
                                                   [](const auto& of) { return of.size(); }) -
                                 stars.triangles.begin());
    REQUIRE(star < kStars);
    for (const simd::Isa isa : supported_isas()) {
      const auto found = stars.folded(simd::table(isa));
      CHECK((found[star / kLanes] >> star % kLanes & 1) == (angle < 1 ? 0 : 1));
    }
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_stars
