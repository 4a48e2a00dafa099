/// predict, commit and apply_displacements against plain scalar code.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/kernel_data.h"

namespace weft::test::kernels_simd_integrate {
namespace {

using kernels::Vector;

Vector acceleration(const Rounding& rounding, const simd::Motion& m, std::size_t i) {
  const double w = m.inverse_mass[i];
  if (w == 0) return {0, 0, 0};
  if (m.force.x == nullptr) return m.gravity;
  return {rounding.fused(w, m.force.x[i], m.gravity.x),
          rounding.fused(w, m.force.y[i], m.gravity.y),
          rounding.fused(w, m.force.z[i], m.gravity.z)};
}

double predicted(const Rounding& rounding, double p, double v, double a, double h) {
  return rounding.fused(0.5 * h * h, a, rounding.fused(h, v, p));
}

Vector predicted(const Rounding& r, const simd::Motion& m, std::size_t i, double h) {
  const Vector p = m.position[i], v = m.velocity[i], a = acceleration(r, m, i);
  return {predicted(r, p.x, v.x, a.x, h), predicted(r, p.y, v.y, a.y, h),
          predicted(r, p.z, v.z, a.z, h)};
}

/// f(table, rounding, data, forces, first, last) for every instruction set, length and range.
template <class F>
void for_every_range(F f) {
  for (const simd::Isa isa : supported_isas()) {
    for (const std::uint32_t length : kLengths) {
      for (const bool forces : {false, true}) {
        CAPTURE(text(isa));
        CAPTURE(length);
        CAPTURE(forces);
        const KernelData data(length, length);
        f(simd::table(isa), Rounding(isa), data, forces, kLanes, data.slots - kLanes);
        f(simd::table(isa), Rounding(isa), data, forces, kLanes, 2 * kLanes);
      }
    }
  }
}

TEST_CASE("predict: p + h v + h^2 a / 2, within the range and nowhere else") {
  for_every_range([](const simd::Table& table, const Rounding& rounding, KernelData found,
                     bool forces, std::size_t first, std::size_t last) {
    KernelData expected = found;
    const simd::Motion m = expected.motion(forces);
    for (std::size_t i = first; i < last; ++i) {
      m.solved.set(i, predicted(rounding, m, i, 0.01));
    }
    table.predict(found.motion(forces), 0.01, first, last);
    CHECK(same(found, expected));
  });
}

TEST_CASE("commit: v + h a + (solved - predicted) / h, within the range and nowhere else") {
  for_every_range([](const simd::Table& table, const Rounding& rounding, KernelData found,
                     bool forces, std::size_t first, std::size_t last) {
    KernelData expected = found;
    const simd::Motion m = expected.motion(forces);
    const double h = 0.01;
    for (std::size_t i = first; i < last; ++i) {
      const Vector v = m.velocity[i], a = acceleration(rounding, m, i);
      const Vector d = m.solved[i] - predicted(rounding, m, i, h);
      m.next_velocity.set(i, {rounding.fused(1 / h, d.x, rounding.fused(h, a.x, v.x)),
                              rounding.fused(1 / h, d.y, rounding.fused(h, a.y, v.y)),
                              rounding.fused(1 / h, d.z, rounding.fused(h, a.z, v.z))});
    }
    table.commit(found.motion(forces), h, first, last);
    CHECK(same(found, expected));
  });
}

TEST_CASE("commit says whether every number is within range, whatever the lane and the axis") {
  constexpr double kHuge = 2 * kernels::kMost;
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    KernelData data(2 * kLanes, 3);
    const simd::Motion m = data.motion(false);
    REQUIRE(table.commit(m, 0.01, 0, data.slots));
    for (std::size_t i = 0; i < data.slots; ++i) {
      for (const double bad : {std::nan(""), kHuge, -kHuge, HUGE_VAL, -HUGE_VAL}) {
        const Vector good = m.solved[i];
        for (const Vector& v : {Vector{bad, good.y, good.z}, Vector{good.x, bad, good.z},
                                Vector{good.x, good.y, bad}}) {
          m.solved.set(i, v);
          REQUIRE_FALSE(table.commit(m, 0.01, 0, data.slots));
        }
        m.solved.set(i, good);
      }
    }
  }
}

TEST_CASE("impulses: sums over the free of a range, equal where instructions fuse") {
  for_every_range([](const simd::Table& table, const Rounding& rounding, KernelData data,
                     bool forces, std::size_t first, std::size_t last) {
    const simd::Motion m = data.motion(forces);
    const double h = 0.01;
    kernels::ImpulseEnergy expected;
    for (std::size_t i = first; i < last; ++i) {
      if (m.inverse_mass[i] == 0) continue;
      const double mass = 1 / m.inverse_mass[i];
      const Vector v = m.velocity[i], next = m.next_velocity[i], a = acceleration(rounding, m, i);
      const Vector kick = (1 / h) * (m.solved[i] - predicted(rounding, m, i, h));
      const Vector rest = next - (v + h * a + kick);
      const double square = dot(next, next);
      const double gain = square - dot(v, v) - 2 * dot(a, m.solved[i] - m.position[i]);
      expected.add({mass * dot(kick, kick), mass * dot(rest, rest), mass * gain, mass * square});
    }
    const kernels::ImpulseEnergy found = table.measure_impulses(m, h, first, last);
    CHECK(found.first == doctest::Approx(expected.first).epsilon(1e-12));
    CHECK(found.second == doctest::Approx(expected.second).epsilon(1e-12));
    CHECK(found.energy == doctest::Approx(expected.energy).epsilon(1e-12));
    CHECK(std::abs(found.gain - expected.gain) < 1e-12 * (expected.first + expected.second));
  });
  if (!simd::supported(simd::Isa::avx512)) return;
  KernelData data(272, 5);
  const auto impulses = [&](simd::Isa isa) {
    return simd::table(isa).measure_impulses(data.motion(true), 0.01, 0, data.slots);
  };
  const kernels::ImpulseEnergy wide = impulses(simd::Isa::avx512),
                               narrow = impulses(simd::Isa::avx2);
  CHECK(wide.first == narrow.first);
  CHECK(wide.second == narrow.second);
  CHECK(wide.gain == narrow.gain);
  CHECK(wide.energy == narrow.energy);
}

TEST_CASE("commit_watched: the same velocities, and the impulses that measure_impulses finds") {
  for_every_range([](const simd::Table& table, const Rounding&, KernelData found, bool forces,
                     std::size_t first, std::size_t last) {
    KernelData expected = found;
    const double h = 0.01;
    const bool finite = table.commit(expected.motion(forces), h, first, last);
    kernels::ImpulseEnergy impulses;
    CHECK(table.commit_watched(found.motion(forces), h, first, last, impulses) == finite);
    CHECK(same(found, expected));
    const kernels::ImpulseEnergy after =
        table.measure_impulses(expected.motion(forces), h, first, last);
    CHECK(impulses.first == doctest::Approx(after.first).epsilon(1e-12));
    CHECK(impulses.second == 0);
    CHECK(impulses.energy == doctest::Approx(after.energy).epsilon(1e-12));
    CHECK(std::abs(impulses.gain - after.gain) <= 1e-12 * (after.first + after.energy));
    found.solved.x[first] = std::nan("");
    CHECK_FALSE(table.commit_watched(found.motion(forces), h, first, last, impulses));
  });
  if (!simd::supported(simd::Isa::avx512)) return;
  KernelData data(272, 5);
  kernels::ImpulseEnergy wide, narrow;
  simd::table(simd::Isa::avx512).commit_watched(data.motion(true), 0.01, 0, data.slots, wide);
  simd::table(simd::Isa::avx2).commit_watched(data.motion(true), 0.01, 0, data.slots, narrow);
  CHECK(wide.first == narrow.first);
  CHECK(wide.gain == narrow.gain);
  CHECK(wide.energy == narrow.energy);
}

TEST_CASE("what was not corrected keeps its velocity to the last bit but the fall's") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    KernelData data(64, 3);
    const simd::Table& table = simd::table(isa);
    table.predict(data.motion(false), 0.01, 0, data.slots);
    table.commit(data.motion(false), 0.01, 0, data.slots);
    const simd::Motion m = data.motion(false);
    for (std::size_t i = 0; i < data.slots; ++i) {
      const Vector a = acceleration(Rounding(isa), m, i);
      REQUIRE(m.next_velocity.y[i] == Rounding(isa).fused(0.01, a.y, m.velocity.y[i]));
    }
  }
}

TEST_CASE("displacements are added to the positions and start anew") {
  for (const simd::Isa isa : supported_isas()) {
    for (const std::uint32_t length : kLengths) {
      CAPTURE(text(isa));
      CAPTURE(length);
      KernelData found(length, length + 1);
      KernelData expected = found;
      const std::size_t first = kLanes, last = found.slots - kLanes;
      for (std::size_t i = first; i < last; ++i) {
        double* const axes[]{&expected.solved.x[i], &expected.solved.y[i], &expected.solved.z[i]};
        for (std::size_t k = 0; k < 3; ++k) {
          float& u = expected.u[k * expected.stride() + i];
          *axes[k] += static_cast<double>(u);
          u = 0;
        }
      }
      simd::table(isa).apply_displacements(found.solved.view(), found.relaxation(1).u, first, last);
      CHECK(same(found, expected));
    }
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_integrate
