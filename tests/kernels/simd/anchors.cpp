/// Anchors in lanes against the same in double, on every instruction set, in quads and woven rows.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/reference/anchors.h"
#include "kernels/simd/table.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"

namespace weft::test::kernels_simd_anchors {
namespace {

using kernels::kLanes;
using kernels::Vector;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kShare = 0.25, kPerSecond = 50, kRate = 1e3, kFar = 0.004;

Vector random_vector(Random& random, double size) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

void set(simd::LaneVectors& v, std::size_t lane, Vector to) {
  v.x[lane] = static_cast<float>(to.x);
  v.y[lane] = static_cast<float>(to.y);
  v.z[lane] = static_cast<float>(to.z);
}
Vector get(const simd::LaneVectors& v, std::size_t lane) {
  return {double{v.x[lane]}, double{v.y[lane]}, double{v.z[lane]}};
}

/// A block whose particles are about as far from their points as they may be: attached, inside and
/// outside, before, on and behind backstops that are flat, wide or as small as the ball, and far
/// enough aside to be pushed out of the ball. Every fifth has no anchor.
struct HeldBlock {
  bool woven;
  kernels::AlignedVector<float> u, predicted, v;
  simd::AnchorBlock block{};
  simd::BackstopBlock backstop{};
  std::vector<reference::AnchorLimits> limits;
  std::uint16_t at_limit = 0, moved = 0;

  HeldBlock(bool is_woven, bool has_backstops, std::uint32_t seed)
      : woven(is_woven), u(4 * kLanes), predicted(4 * kLanes), v(4 * kLanes) {
    Random random(seed);
    block.backstop = has_backstops ? 0 : -1;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const bool has_anchor = lane % 5 != 4;
      reference::AnchorLimits limit{.most = kInfinity};
      if (has_anchor && lane % 7 != 6) limit.most = lane % 5 == 0 ? 0 : random.between(0.01, 0.04);
      if (has_anchor && has_backstops && lane % 3 != 2) {
        limit.has_backstop = true;
        limit.distance = random.between(0, 0.02);
        limit.curvature = lane % 4 == 0 ? 0 : 1 / random.between(0.01, 3);
      }
      limits.push_back(limit);
      const Vector point = random_vector(random, 0.02);
      set(block.point, lane, point);
      set(block.way, lane, random_vector(random, 0.01));
      block.most[lane] = static_cast<float>(limit.most);
      block.far[lane] = static_cast<float>(kFar * kFar);
      if (limit.has_backstop) {
        const Vector n = random_vector(random, 1);
        const Vector normal = (1 / length(n)) * n;
        set(backstop.normal, lane, normal);
        set(backstop.turn, lane, random_vector(random, 0.1));
        backstop.distance[lane] = static_cast<float>(limit.distance);
        backstop.curvature[lane] = static_cast<float>(limit.curvature);
      }
      write(u, lane, point + random_vector(random, 0.04));
      write(predicted, lane, read(u, lane) + random_vector(random, 1e-3));
      write(v, lane, random_vector(random, 2));
    }
  }
  std::size_t place(std::size_t lane) const { return woven ? lane : 4 * lane; }
  std::size_t next() const { return woven ? kLanes : 1; }
  Vector read(const kernels::AlignedVector<float>& from, std::size_t lane) const {
    const std::size_t at = place(lane);
    return {double{from[at]}, double{from[at + next()]}, double{from[at + 2 * next()]}};
  }
  void write(kernels::AlignedVector<float>& to, std::size_t lane, Vector value) const {
    const std::size_t at = place(lane);
    to[at] = static_cast<float>(value.x);
    to[at + next()] = static_cast<float>(value.y);
    to[at + 2 * next()] = static_cast<float>(value.z);
  }
  Vector settled(std::size_t lane) const {
    return read(v, lane) + kRate * (read(u, lane) - read(predicted, lane));
  }
  reference::AnchorMotion motion(std::size_t lane) const {
    const Vector point = get(block.point, lane), normal = get(backstop.normal, lane);
    return reference::AnchorMotion::between(
        {point, normal}, {point + get(block.way, lane), normal + get(backstop.turn, lane)}, kShare,
        kPerSecond);
  }
  void hold(const simd::Table& table) {
    const simd::AnchorSolve hold{
        .flight = {.u = u.data(), .predicted = predicted.data(), .v = v.data(), .led_to = u.data()},
        .blocks = &block,
        .backstops = &backstop,
        .at_limit = &at_limit,
        .moved = &moved,
        .woven = woven,
        .rate = static_cast<float>(kRate),
        .share = static_cast<float>(kShare),
        .per_second = static_cast<float>(kPerSecond)};
    table.hold_anchors(hold, 0, 1);
  }
};

/// How many of its particles were at a limit.
int check_against_reference(const simd::Table& table, bool woven, bool backstops,
                            std::uint32_t seed) {
  const HeldBlock before(woven, backstops, seed);
  HeldBlock after = before;
  after.hold(table);
  int held = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    CAPTURE(seed);
    CAPTURE(lane);
    const Vector from = before.read(before.u, lane);
    const reference::Held expected =
        hold(before.limits[lane], before.motion(lane), from, before.settled(lane));
    CHECK((after.at_limit >> lane & 1) == (expected.is_at_limit ? 1 : 0));
    CHECK(length(after.read(after.u, lane) - expected.x) < 1e-7);
    CHECK(length(after.settled(lane) - expected.v) < 2e-4);
    CHECK(excess(before.limits[lane], before.motion(lane), after.read(after.u, lane)) < 1e-7);
    const double way = length(expected.x - from);
    if (std::abs(way - kFar) > 1e-6) CHECK((after.moved >> lane & 1) == (way > kFar ? 1 : 0));
    held += expected.is_at_limit ? 1 : 0;
  }
  return held;
}

TEST_CASE("particles are held by their anchors as in double") {
  for (const simd::Isa isa : supported_isas()) {
    for (const bool woven : {false, true}) {
      for (const bool backstops : {false, true}) {
        CAPTURE(text(isa));
        CAPTURE(woven);
        CAPTURE(backstops);
        int held = 0;
        for (std::uint32_t seed = 1; seed <= 200; ++seed) {
          held += check_against_reference(simd::table(isa), woven, backstops, seed);
        }
        CHECK(held > 1000);
        CHECK(held < 3000);
      }
    }
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_anchors
