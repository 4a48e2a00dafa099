/// Sweeps over yarns that look whether errors are small, and solve again where they are not.
#include <doctest/doctest.h>

#include <algorithm>

#include "engine/solvers/yarn/yarn_layout.h"
#include "tests/support/isas.h"
#include "tests/support/yarn_block.h"

namespace weft::test::kernels_simd_watched_yarns {
namespace {

/// Far: links turn by much when they are straightened.
void bend(BlockOfYarns& b) {
  Random random(11);
  for (std::size_t i = 0; i < b.x.size(); ++i) {
    const kernels::Vector by{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    b.x.set(i, b.x[i] + 0.02 * by);
  }
}

TEST_CASE("a watched sweep moves as any other, tells whether much is left, and spares the easy") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    const auto sweep = [&](BlockOfYarns& b, double enough) {
      b.start(table);
      return table.yarn_sweep_watched(b.yarns(), b.block(), b.u.data(), b.scratch.data(),
                                      static_cast<float>(enough), 1);
    };
    BlockOfYarns plain, strict, easy;
    plain.start(table);
    table.yarn_sweep(plain.yarns(), plain.block(), plain.u.data(), plain.scratch.data());
    const double left = largest_strain(plain, plain.end(table));
    CHECK(left > 1e-5);
    CHECK(left < 0.1 * largest_strain(plain, plain.x));
    CHECK(!sweep(strict, 0.95 * left).within);
    CHECK(sweep(easy, 1.05 * left).within);
    CHECK(strict.u == plain.u);
    CHECK(easy.u == plain.u);
    plain.start(table);
    const auto before = plain.u;
    const simd::Swept swept = table.yarn_sweep_watched(plain.yarns(), plain.block(), plain.u.data(),
                                                       plain.scratch.data(), 2.f, 1);
    CHECK(swept.solves == 0);
    CHECK(swept.within);
    CHECK(plain.u == before);
  }
}

TEST_CASE("a block is solved again, as by as many calls, until it is within, or often enough") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    for (const Stand stand : kStands) {
      for (const bool from_memory : {false, true}) {
        BlockOfYarns at_once(stand), one_by_one(stand), limited(stand);
        const auto sweep = [&](BlockOfYarns& b, std::uint32_t most) {
          return table.yarn_sweep_watched(b.yarns(), b.block(), b.u.data(), b.scratch.data(), 1e-5f,
                                          most);
        };
        for (BlockOfYarns* b : {&at_once, &one_by_one, &limited}) {
          b->from_memory = from_memory;
          bend(*b);
          b->start(table);
        }
        const simd::Swept swept = sweep(at_once, 20);
        CHECK(swept.within);
        CHECK(swept.solves > 3);
        CHECK(swept.solves < 10);
        for (std::uint32_t i = 0; i < swept.solves; ++i) {
          const simd::Swept one = sweep(one_by_one, 1);
          CHECK(one.solves == 1);
          CHECK(one.within == (i + 1 == swept.solves));
        }
        const kernels::Vectors x = at_once.end(table), y = one_by_one.end(table);
        CHECK(largest_strain(at_once, x) < 1.1e-5);
        for (std::size_t i = 0; i < x.size(); ++i) CHECK(kernels::length(x[i] - y[i]) < 1e-6);
        CHECK(sweep(limited, swept.solves - 1).solves == swept.solves - 1);
        CHECK(largest_strain(limited, limited.end(table)) > 1e-5);
      }
    }
  }
}

TEST_CASE("a link that has all but collapsed is not left alone") {
  constexpr std::uint32_t kLane = 2;  // of two particles
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    BlockOfYarns b;
    for (simd::YarnRow& row : b.rows) std::fill(row.rest + kLane + 1, row.rest + kLanes, 0.f);
    const double rest = static_cast<double>(b.rows[0].rest[kLane]);
    b.rows[0].inverse_mass[kLane] = b.rows[1].inverse_mass[kLane] = 1;
    b.x.set(b.slot_of(0, kLane), {0, 0, 0});
    b.x.set(b.slot_of(1, kLane), {1e-7 * rest, 0, 0});
    b.start(table);
    CHECK(table.yarn_sweep_watched(b.yarns(), b.block(), b.u.data(), b.scratch.data(), 1e-3f, 1)
              .solves == 1);
    const kernels::Vectors moved = b.end(table);
    const double l = kernels::length(moved[b.slot_of(0, kLane)] - moved[b.slot_of(1, kLane)]);
    CHECK(l == doctest::Approx(rest));
  }
}

TEST_CASE("far away, what is not there does not hide what is out of tolerance") {
  constexpr double kLarge = 0x1p60, kFar = 30 * kLarge;  // kFar^2 is no float
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    for (const Stand stand : kStands) {
      CAPTURE(static_cast<int>(stand));
      BlockOfYarns b(stand);
      bend(b);
      b.cell *= kLarge;
      for (simd::YarnRow& row : b.rows) {
        for (float& rest : row.rest) rest *= static_cast<float>(kLarge);
      }
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        for (std::uint32_t k = 0; k < BlockOfYarns::length(lane); ++k) {
          const std::size_t slot = b.slot_of(k, lane);
          b.x.set(slot, kLarge * b.x[slot] + kernels::Vector{kFar, kFar, kFar});
        }
      }
      b.start(table);
      const auto sweep = [&](float enough) {
        return table.yarn_sweep_watched(b.yarns(), b.block(), b.u.data(), b.scratch.data(), enough,
                                        1);
      };
      CHECK(sweep(1e-3f).solves == 1);
      CHECK(sweep(0.5f).within);
    }
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_watched_yarns
