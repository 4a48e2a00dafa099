/// Positions as two floats, in woven rows.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>

#include "kernels/simd/table.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"

namespace weft::test::kernels_simd_split {
namespace {

using kernels::kLanes;

constexpr std::size_t kSlots = 5 * kLanes;

/// Fours of which none, some or all slots are the row's, and a row whose slots are all in a row.
struct TwoRows {
  simd::WovenRow rows[2];
  kernels::Vectors x{kSlots};
  kernels::AlignedVector<float> base, u;

  TwoRows() : base(6 * kLanes, 7.f), u(6 * kLanes, 7.f) {
    rows[0] = {.place = 3 * kLanes, .four = {3, 11, 19, 27}, .count = {4, 3, 0, 1}};
    rows[1] = {.place = 0, .in_a_row = true};
    for (std::uint32_t i = 0; i < simd::WovenRow::kFours; ++i) {
      rows[1].four[i] = 3 * kLanes + 4 * i;
      rows[1].count[i] = 4;
    }
    Random random(7);
    for (std::size_t i = 0; i < kSlots; ++i) {
      const Vec3 p = random.in_box(10);
      x.set(i, {p.x, p.y, p.z});
    }
  }
  /// work(a float's place, the number of its axis, its slot, whether that is the row's)
  template <class Work>
  void for_each_lane(Work&& work) const {
    for (const simd::WovenRow& row : rows) {
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        const std::uint32_t four = lane / 4, k = lane % 4;
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
          work(row.place + axis * kLanes + lane, axis, row.four[four] + k, k < row.count[four]);
        }
      }
    }
  }
};

double component(kernels::Vector v, std::uint32_t axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

TEST_CASE("rows are split and joined as their own slots say; what is nobody's is 0") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    TwoRows r;
    table.split_rows(r.x.view(), r.rows, 2, 0x1p-10, r.base.data(), r.u.data());
    r.for_each_lane([&](std::size_t place, std::uint32_t axis, std::size_t slot, bool own) {
      const double found = static_cast<double>(r.base[place]) + static_cast<double>(r.u[place]);
      const double expected = own ? component(r.x[slot], axis) : 0;
      CHECK(found == doctest::Approx(expected).epsilon(1e-9));
    });
    for (float& u : r.u) u += 1;
    kernels::Vectors moved = r.x, expected = r.x;
    r.for_each_lane([&](std::size_t, std::uint32_t axis, std::size_t slot, bool own) {
      double* const axes[]{&expected.x[slot], &expected.y[slot], &expected.z[slot]};
      if (own) *axes[axis] += 1;
    });
    table.join_rows(moved.view(), r.rows, 2, r.base.data(), r.u.data());
    for (std::size_t i = 0; i < kSlots; ++i) {
      CHECK(kernels::length(moved[i] - expected[i]) < 1e-6);
    }
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_split
