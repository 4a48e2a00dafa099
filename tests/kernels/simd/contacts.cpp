/// Contacts of one sphere, and the search for them, against plain scalar code.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>

#include "tests/support/kernel_data.h"

namespace weft::test {
namespace {

constexpr std::uint32_t kSphere = 3;

/// All singles start at the sphere and end elsewhere; contacts have pushed before.
KernelData touching(std::uint32_t length) {
  KernelData data(length, length + 7);
  for (std::uint32_t c = data.first; c < data.last; ++c) {
    data.a[c] = kSphere;
    if (data.b[c] == kSphere) data.make_padding(c);
    if (!data.is_padding(c)) data.impulse[c] = -data.impulse[c];
  }
  return data;
}

/// Sum of 16 as a balanced tree, halves first.
float tree_sum(std::array<float, kLanes> lanes) {
  for (std::uint32_t half = kLanes / 2; half > 0; half /= 2) {
    for (std::uint32_t k = 0; k < half; ++k) lanes[k] += lanes[k + half];
  }
  return lanes[0];
}

/// Contacts [first, first + kLanes), all as the sphere stood before.
std::uint32_t visit_block(const Rounding& rounding, KernelData& data, std::uint32_t first,
                          float threshold) {
  const KernelData before = data;
  std::array<float, kLanes> push[3]{};
  std::uint32_t corrections = 0;
  for (std::uint32_t k = 0; k < kLanes; ++k) {
    const std::uint32_t c = first + k, p = data.b[c];
    const float e = before.error(rounding, c, kSphere, p);
    const float change = std::min(e, -data.impulse[c]);
    if (!(std::abs(e) > threshold) || change == 0) continue;
    ++corrections;
    const Lane lane = data.lane(c);
    data.impulse[c] += change;
    data.move(rounding, p, change * lane.gain_b, lane);
    const float at_sphere = change * lane.gain_a;
    push[0][k] = at_sphere * lane.nx;
    push[1][k] = at_sphere * lane.ny;
    push[2][k] = at_sphere * lane.nz;
  }
  for (std::size_t axis = 0; axis < 3 && corrections > 0; ++axis) {
    data.u[axis * data.stride() + kSphere] += tree_sum(push[axis]);
  }
  return corrections;
}

TEST_CASE("contacts push, sixteen at a time, and the sphere takes the sum") {
  for (const simd::Isa isa : supported_isas()) {
    for (const std::uint32_t length : kLengths) {
      for (const float threshold : {1.0f, 0.0f, 1e9f}) {
        CAPTURE(text(isa));
        CAPTURE(length);
        CAPTURE(threshold);
        KernelData found = touching(length), expected = touching(length);
        const simd::Relaxation r = found.relaxation(threshold);
        for (int pass = 0; pass < 3; ++pass) {
          std::uint32_t wanted = 0;
          for (std::uint32_t c = found.first; c < found.last; c += kLanes) {
            wanted += visit_block(Rounding(isa), expected, c, threshold);
          }
          const auto count = simd::table(isa).relax_contacts(r, found.first, found.last);
          REQUIRE(count == wanted);
          REQUIRE(same(found, expected));
          if (pass == 0) CHECK((count > 0) == (threshold <= 1));
        }
        for (std::uint32_t c = found.first; c < found.last; ++c) REQUIRE(found.impulse[c] <= 0);
      }
    }
  }
}

TEST_CASE("find_near lists what is nearer than its reach, in order, among the first slots") {
  for (const simd::Isa isa : supported_isas()) {
    for (const std::uint32_t length : kLengths) {
      for (const double extra : {0.0, 0.4, 5.0}) {
        CAPTURE(text(isa));
        CAPTURE(length);
        CAPTURE(extra);
        KernelData data(length, length + 8);
        const kernels::Vector centre{0.1, -0.2, 0.3};
        const std::size_t slots = data.slots - kLanes;
        std::vector<std::uint32_t> expected;
        for (std::size_t i = 0; i < slots; ++i) {
          const kernels::Vector d = data.position[i] - centre;
          const double limit = data.reach[i] + extra;
          if (Rounding(isa).dot(d, d) < limit * limit) {
            expected.push_back(static_cast<std::uint32_t>(i));
          }
        }
        std::vector<std::uint32_t> found(data.slots);
        found.resize(simd::table(isa).find_near(data.position.view(), data.reach.data(), centre,
                                                extra, slots, found.data()));
        CHECK(found == expected);
        CHECK((extra != 5 || found.size() == slots));
        CHECK((extra == 5 || found.size() < slots));
      }
    }
  }
}

TEST_CASE(
    "find_moved lists what has moved farther than its reach, in order, among the first slots") {
  for (const simd::Isa isa : supported_isas()) {
    for (const std::uint32_t length : kLengths) {
      for (const double part : {0.0, 0.4, 50.0}) {
        CAPTURE(text(isa));
        CAPTURE(length);
        CAPTURE(part);
        KernelData data(length, length + 9);
        const kernels::Vector along{0.1, -0.2, 0.3};
        const std::size_t slots = data.slots - kLanes;
        std::vector<std::uint32_t> expected;
        for (std::size_t i = 0; i < slots; ++i) {
          const kernels::Vector way = data.position[i] - data.velocity[i] - along;
          const double limit = part * (data.reach[i] + 1.5);
          if (Rounding(isa).dot(way, way) > limit * limit) {
            expected.push_back(static_cast<std::uint32_t>(i));
          }
        }
        std::vector<std::uint32_t> found(data.slots);
        found.resize(simd::table(isa).find_moved(data.velocity.view(), data.position.view(), along,
                                                 data.reach.data(), 1.5, part, slots,
                                                 found.data()));
        CHECK(found == expected);
        CHECK((part != 0 || found.size() == slots));
        CHECK((part != 50 || found.empty()));
      }
    }
  }
}

}  // namespace
}  // namespace weft::test
