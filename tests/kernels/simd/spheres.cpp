/// Contacts of one sphere, and the search for them, against plain scalar code.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "tests/support/kernel_data.h"
#include "tests/support/vectors.h"

namespace weft::test::kernels_simd_spheres {
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
        const simd::BlockRelaxation r = found.relaxation(threshold);
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

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Boxes of more slots than one holds, some of them padding or not numbers; none in the second.
struct BoxData {
  static constexpr std::size_t kSlots = 3 * simd::kBoxed + 2 * kLanes;
  kernels::Vectors x{kSlots}, low{kLanes}, high{kLanes};
  kernels::AlignedVector<double> mass = kernels::AlignedVector<double>(kSlots);
  kernels::AlignedVector<double> reach = kernels::AlignedVector<double>(kLanes);

  explicit BoxData(std::uint32_t seed) {
    Random random(seed);
    for (std::size_t i = 0; i < kSlots; ++i) {
      const Vec3 at = random.in_box(1);
      const auto offset = static_cast<double>(i / simd::kBoxed);
      x.set(i, {at.x + 5 * offset, at.y - 8 * offset, at.z + 3});
      const bool second = i / simd::kBoxed == 1;
      mass[i] = second || random.below(4) == 0 ? 0 : random.between(0.1, 1);
      if (mass[i] == 0) x.set(i, {0, 0, 0});
    }
    x.y[3] = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t box = 0; box < kLanes; ++box) {
      low.set(box, {kInfinity, kInfinity, kInfinity});
      high.set(box, {-kInfinity, -kInfinity, -kInfinity});
      reach[box] = box < 4 ? random.between(0, 0.5) : 0;
    }
  }
  simd::Boxes boxes() { return {low.view(), high.view(), reach.data(), kLanes}; }

  void grow(std::size_t slot) {
    const std::size_t box = slot / simd::kBoxed;
    const auto by = [&](double at, double& least, double& most) {
      if (at < least) least = at;
      if (at > most) most = at;
    };
    by(x.x[slot], low.x[box], high.x[box]);
    by(x.y[slot], low.y[box], high.y[box]);
    by(x.z[slot], low.z[box], high.z[box]);
  }
  bool same(const BoxData& other) const {
    return low.x == other.low.x && low.y == other.low.y && low.z == other.low.z &&
           high.x == other.high.x && high.y == other.high.y && high.z == other.high.z;
  }
};

TEST_CASE("boxes grow by what has mass, and by nothing else") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    BoxData found(1), expected(1);
    for (int pass = 0; pass < 2; ++pass) {
      simd::table(isa).bound(found.x.view(), found.mass.data(), BoxData::kSlots, found.boxes());
      for (std::size_t i = 0; i < BoxData::kSlots; ++i) {
        if (expected.mass[i] > 0) expected.grow(i);
      }
      REQUIRE(found.same(expected));
      found.x.set(0, {-7, 30, 0.5});
      expected.x.set(0, {-7, 30, 0.5});
      found.mass[0] = expected.mass[0] = 1;
    }
    CHECK(found.low.x[0] == -7);
    CHECK(found.low.x[1] == kInfinity);
    CHECK(found.high.x[1] == -kInfinity);
    CHECK(found.low.y[3] > -26);
  }
}

TEST_CASE("find_boxes lists those within reach, none that is empty, all of what is no number") {
  const auto gap = [](double low, double high, double from, double to) {
    return std::max(low - to, from - high);
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    BoxData data(2);
    const simd::Table& table = simd::table(isa);
    table.bound(data.x.view(), data.mass.data(), BoxData::kSlots, data.boxes());
    Random random(3);
    std::vector<std::uint32_t> found(kLanes);
    const auto find = [&](kernels::Vector from, kernels::Vector to, double extra) {
      found.resize(kLanes);
      found.resize(table.find_boxes(data.boxes(), from, to, extra, found.data()));
      return found;
    };
    std::size_t near = 0;
    for (int trial = 0; trial < 1000; ++trial) {
      Vec3 centre = random.in_box(6);
      const Vec3 half = random.in_box(2);
      if (trial % 2 == 0) centre = centre + Vec3{10, -16, 3};
      const kernels::Vector from{centre.x - std::abs(half.x), centre.y - std::abs(half.y),
                                 centre.z - std::abs(half.z)};
      const kernels::Vector to{centre.x + std::abs(half.x), centre.y + std::abs(half.y),
                               centre.z + std::abs(half.z)};
      const double extra = random.between(0, 3);
      std::vector<std::uint32_t> expected;
      for (std::uint32_t box = 0; box < kLanes; ++box) {
        const double widest = std::max({gap(data.low.x[box], data.high.x[box], from.x, to.x),
                                        gap(data.low.y[box], data.high.y[box], from.y, to.y),
                                        gap(data.low.z[box], data.high.z[box], from.z, to.z)});
        if (widest <= data.reach[box] + extra) expected.push_back(box);
      }
      REQUIRE(find(from, to, extra) == expected);
      near += expected.size();
    }
    CHECK(near > 100);
    const double edge = data.high.x[0] + data.reach[0] + 1;
    const kernels::Vector at{edge, data.low.y[0], data.low.z[0]};
    CHECK(find(at, at, 1) == std::vector<std::uint32_t>{0});
    CHECK(find({kNan, 0, 0}, {kNan, 0, 0}, 1).size() == kLanes);
    CHECK(find({-kInfinity, 0, 0}, {1e9, 0, 0}, 1).size() >= 3);
    data.high.x[2] = kInfinity;
    CHECK(find({0, 100, 0}, {0, 100, 0}, 1) == std::vector<std::uint32_t>{2});
  }
}

TEST_CASE("find_near lists what is nearer than its reach, in order, among a range of slots") {
  for (const simd::Isa isa : supported_isas()) {
    for (const std::uint32_t length : kLengths) {
      for (const double extra : {0.0, 0.4, 5.0}) {
        CAPTURE(text(isa));
        CAPTURE(length);
        CAPTURE(extra);
        KernelData data(length, length + 8);
        const kernels::Vector centre{0.1, -0.2, 0.3};
        const std::size_t first = kLanes, last = data.slots - kLanes;
        std::vector<std::uint32_t> expected;
        for (std::size_t i = first; i < last; ++i) {
          const kernels::Vector d = data.position[i] - centre;
          const double limit = data.reach[i] + extra;
          if (Rounding(isa).dot(d, d) < limit * limit) {
            expected.push_back(static_cast<std::uint32_t>(i));
          }
        }
        std::vector<std::uint32_t> found(data.slots);
        found.resize(simd::table(isa).find_near(data.position.view(), data.reach.data(), centre,
                                                extra, first, last, found.data()));
        CHECK(found == expected);
        CHECK((extra != 5 || found.size() == last - first));
        CHECK((extra == 5 || found.size() < last - first));
      }
    }
  }
}

TEST_CASE(
    "find_moved lists what has moved farther than its reach, in order, among a range of slots") {
  for (const simd::Isa isa : supported_isas()) {
    for (const std::uint32_t length : kLengths) {
      for (const double part : {0.0, 0.4, 50.0}) {
        CAPTURE(text(isa));
        CAPTURE(length);
        CAPTURE(part);
        KernelData data(length, length + 9);
        const kernels::Vector along{0.1, -0.2, 0.3};
        const std::size_t first = kLanes, last = data.slots - kLanes;
        std::vector<std::uint32_t> expected;
        for (std::size_t i = first; i < last; ++i) {
          const kernels::Vector way = data.position[i] - data.velocity[i] - along;
          const double limit = part * (data.reach[i] + 1.5);
          if (Rounding(isa).dot(way, way) > limit * limit) {
            expected.push_back(static_cast<std::uint32_t>(i));
          }
        }
        std::vector<std::uint32_t> found(data.slots);
        found.resize(simd::table(isa).find_moved(data.velocity.view(), data.position.view(), along,
                                                 data.reach.data(), 1.5, part, first, last,
                                                 found.data()));
        CHECK(found == expected);
        CHECK((part != 0 || found.size() == last - first));
        CHECK((part != 50 || found.empty()));
      }
    }
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_spheres
