/// The linear system of yarns against dense solutions in double, on every instruction set.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "engine/solvers/yarn/yarn_layout.h"
#include "tests/support/isas.h"
#include "tests/support/yarn_block.h"

namespace weft::test::kernels_simd_yarn_system {
namespace {

/// With one family, which is its own preconditioner, the first step is the solution.
void solve_system(BlockOfYarns& b, const simd::Yarns& yarns, const simd::Table& table) {
  kernels::AlignedVector<float> t(b.u.size());
  const simd::YarnProducts before = table.yarn_precondition(yarns, b.block(), 0);
  table.yarn_push(yarns, b.block(), 0, t.data(), b.scratch.data());
  const float curvature = table.yarn_pull(yarns, b.block(), t.data(), b.scratch.data());
  CHECK(before.product / curvature == doctest::Approx(1).epsilon(1e-5));
  const auto after = table.yarn_precondition(yarns, b.block(), before.product / curvature);
  CHECK(after.worst < 1e-4f * before.worst);
  table.yarn_finish(yarns, b.block(), b.u.data(), b.scratch.data());
}

TEST_CASE("what conjugate gradients are made of agrees with one exact solve") {
  const BlockOfYarns untouched;
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    BlockOfYarns b;
    const simd::Table& table = simd::table(isa);
    b.start(table);
    table.yarn_linearise(b.yarns(), b.block(), b.u.data(), b.scratch.data());
    CHECK(table.yarn_precondition(b.yarns(), b.block(), 0).worst ==
          doctest::Approx(0.01).epsilon(0.05));
    solve_system(b, b.yarns(), table);
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      const auto expected = solved_densely(untouched, lane);
      for (std::uint32_t k = 0; k < BlockOfYarns::length(lane); ++k) {
        CHECK(kernels::length(moved[b.slot_of(k, lane)] - expected[k]) < 1e-7);
      }
    }
  }
}

TEST_CASE("springs: the linear system and the elimination have one exact solution, and sum it up") {
  BlockOfYarns untouched;
  untouched.soften();
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    for (const bool eliminates : {false, true}) {
      CAPTURE(eliminates);
      BlockOfYarns b;
      b.soften();
      b.start(table);
      table.yarn_linearise(b.yarns(), b.block(), b.u.data(), b.scratch.data());
      if (eliminates) {
        table.yarn_eliminate(b.yarns(), b.block(), b.t.data(), simd::YarnElimination::last,
                             b.scratch.data());
        table.yarn_add(b.u.data(), b.t.data(), 0, b.u.size());
      } else {
        solve_system(b, b.yarns(), table);
      }
      const kernels::Vectors moved = b.end(table);
      for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
        const auto expected = solved_densely(untouched, lane);
        const auto n = directions(untouched, untouched.x, lane);
        for (std::uint32_t k = 0; k < BlockOfYarns::length(lane); ++k) {
          CHECK(kernels::length(moved[b.slot_of(k, lane)] - expected[k]) < 1e-7);
          if (k == n.size()) continue;
          const kernels::Vector d = moved[b.slot_of(k, lane)] - moved[b.slot_of(k + 1, lane)];
          const double rest = static_cast<double>(b.rows[k].rest[lane]);
          CHECK(std::abs(dot(n[k], d) - rest - b.give(k, lane)) < 1e-6);
        }
      }
    }
  }
}

/// A block whose system has p, z and q of a second iteration.
BlockOfYarns in_conjugate_gradients(const simd::Table& table) {
  BlockOfYarns b;
  b.start(table);
  table.yarn_linearise(b.yarns(), b.block(), b.u.data(), b.scratch.data());
  table.yarn_precondition(b.yarns(), b.block(), 0);
  table.yarn_push(b.yarns(), b.block(), 0, b.t.data(), b.scratch.data());
  table.yarn_pull(b.yarns(), b.block(), b.t.data(), b.scratch.data());
  table.yarn_precondition(b.yarns(), b.block(), 0.5f);
  return b;
}

TEST_CASE("pushing first is pushing onto nothing") {
  constexpr float kBeta = 0.25f;
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    BlockOfYarns onto = in_conjugate_gradients(table), first = onto;
    std::ranges::fill(onto.t, 0.f);
    std::ranges::fill(first.t, 7.f);
    table.yarn_push(onto.yarns(), onto.block(), kBeta, onto.t.data(), onto.scratch.data());
    table.yarn_push_first(first.yarns(), first.block(), kBeta, first.t.data(),
                          first.scratch.data());
    for (const std::uint32_t slot : onto.slot) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        CHECK(first.t[4 * slot + axis] == onto.t[4 * slot + axis]);
      }
    }
    CHECK(first.system_floats() == onto.system_floats());
    CHECK(table.yarn_pull(onto.yarns(), onto.block(), onto.t.data(), onto.scratch.data()) > 0);
  }
}

TEST_CASE("elimination leaves nothing that changes a length, errors and all") {
  const BlockOfYarns untouched;
  const kernels::Vectors pushed = scattered(kernels::Vectors(untouched.x.size()), 0.01);
  for (const simd::Isa isa : supported_isas()) {
    for (const bool errors : {false, true}) {
      CAPTURE(text(isa));
      CAPTURE(errors);
      BlockOfYarns b;
      const simd::Table& table = simd::table(isa);
      b.start(table);
      table.yarn_linearise(b.yarns(), b.block(), b.u.data(), b.scratch.data());
      b.push(pushed);
      const auto what = errors ? simd::YarnElimination::errors : simd::YarnElimination::changes;
      table.yarn_eliminate(b.yarns(), b.block(), b.t.data(), what, b.scratch.data());
      for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
        const auto n = directions(untouched, untouched.x, lane);
        Eigen::VectorXd e = length_errors(untouched, lane);
        if (!errors) e.setZero();
        for (std::uint32_t k = 0; k < n.size(); ++k) {
          const kernels::Vector d = pushed[b.slot_of(k, lane)] - pushed[b.slot_of(k + 1, lane)];
          e[k] += kernels::dot(n[k], d);
        }
        const auto expected = solved_densely(untouched, lane, pushed, n, n, e);
        for (std::uint32_t k = 0; k < BlockOfYarns::length(lane); ++k) {
          CHECK(kernels::length(b.t_of(k, lane) - expected[k]) < 1e-7);
        }
      }
    }
  }
}

TEST_CASE("displacements are added one by one") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    kernels::AlignedVector<float> u(6 * kLanes), t(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) {
      u[i] = static_cast<float>(i);
      t[i] = 0.5f;
    }
    simd::table(isa).yarn_add(u.data(), t.data(), kLanes, 4 * kLanes);
    for (std::size_t i = 0; i < u.size(); ++i) {
      const bool inside = i >= kLanes && i < 4 * kLanes;
      CHECK(u[i] == static_cast<float>(i) + (inside ? 0.5f : 0.f));
    }
  }
}

TEST_CASE("rattle: the linear system has the directions at the start, and the errors at x") {
  const BlockOfYarns untouched;
  const kernels::Vectors q = scattered(untouched.x, 0.02);
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    BlockOfYarns b;
    const simd::Table& table = simd::table(isa);
    b.keep_start(table, q);
    b.start(table);
    table.yarn_linearise(b.yarns(), b.block(), b.u.data(), b.scratch.data());
    solve_system(b, b.yarns(), table);
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      const auto s = directions(untouched, q, lane);
      const auto expected =
          solved_densely(untouched, lane, untouched.x, s, s, length_errors(untouched, lane));
      for (std::uint32_t k = 0; k < BlockOfYarns::length(lane); ++k) {
        CHECK(kernels::length(moved[b.slot_of(k, lane)] - expected[k]) < 1e-7);
      }
    }
  }
}

TEST_CASE("velocities: the linear system takes them out along each link") {
  const BlockOfYarns untouched;
  const kernels::Vectors v = scattered(kernels::Vectors(untouched.x.size()), 1);
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    BlockOfYarns b;
    const simd::Table& table = simd::table(isa);
    simd::Yarns yarns = b.yarns();
    yarns.velocities = true;
    b.start(table);
    table.yarn_linearise(yarns, b.block(), b.u.data(), b.scratch.data());
    b.split(table, v, 0);
    table.yarn_read(yarns, b.block(), b.u.data(), b.scratch.data());
    solve_system(b, yarns, table);
    const kernels::Vectors moved = b.end(table, v);
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      const auto n = directions(untouched, untouched.x, lane);
      Eigen::VectorXd e(static_cast<Eigen::Index>(n.size()));
      for (std::uint32_t k = 0; k < n.size(); ++k) {
        e[k] = kernels::dot(n[k], v[b.slot_of(k, lane)] - v[b.slot_of(k + 1, lane)]);
      }
      const auto expected = solved_densely(untouched, lane, v, n, n, e);
      for (std::uint32_t k = 0; k < BlockOfYarns::length(lane); ++k) {
        CHECK(kernels::length(moved[b.slot_of(k, lane)] - expected[k]) < 2e-5);
      }
    }
  }
}

/// Where the kernels of an instruction set have it (kernels/simd/yarn_arrays.h).
float& residual(BlockOfYarns& b, simd::Isa isa, std::uint32_t k, std::uint32_t lane) {
  constexpr std::uint32_t kArrays = 10, kBefore = 6;  // of a row; n, m, reciprocal and lambda
  const std::uint32_t width = isa == simd::Isa::avx512 ? 16 : isa == simd::Isa::avx2 ? 8 : 4;
  const std::uint32_t row = lane / width * BlockOfYarns::kRows + k;
  float* floats = reinterpret_cast<float*>(b.system.data());
  return floats[(kArrays * row + kBefore) * width + lane % width];
}

TEST_CASE("one velocity or error that is no number is seen, whatever its lane and row") {
  const float bad = std::numeric_limits<float>::quiet_NaN();
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    BlockOfYarns b;
    b.start(table);
    table.yarn_linearise(b.yarns(), b.block(), b.u.data(), b.scratch.data());
    const auto read = [&] {
      return table.yarn_read(b.yarns(), b.block(), b.u.data(), b.scratch.data());
    };
    const auto product = [&] { return table.yarn_precondition(b.yarns(), b.block(), 0).product; };
    REQUIRE(std::isfinite(read()));
    REQUIRE(std::isfinite(product()));
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      for (std::uint32_t k = 0; k + 1 < BlockOfYarns::length(lane); ++k) {
        const float kept = std::exchange(b.u[b.place_of(k, lane)], bad);
        REQUIRE_FALSE(std::isfinite(read()));
        b.u[b.place_of(k, lane)] = kept;
        read();
        REQUIRE(std::isfinite(product()));
        residual(b, isa, k, lane) = bad;
        REQUIRE_FALSE(std::isfinite(product()));
        read();
      }
    }
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_yarn_system
