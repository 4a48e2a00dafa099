/// Yarns against dense solutions in double, on every instruction set.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <vector>

#include "kernels/simd/table.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"

namespace weft::test {
namespace {

using kernels::kLanes;

/// A block of kLanes yarns of lanes 0 ... kLanes - 1 particles, each with slots of its own, bent at
/// random and stretched by up to a hundredth; some particles are fixed.
struct Block {
  static constexpr std::uint32_t kRows = kLanes;
  std::vector<std::uint32_t> slot;
  kernels::AlignedVector<simd::YarnRow> rows;
  kernels::AlignedVector<simd::YarnSystemRow> system;
  kernels::AlignedVector<simd::YarnScratch> scratch;
  kernels::AlignedVector<float> base, u, t;
  kernels::Vectors x;

  Block() : rows(kRows), system(kRows), scratch(kRows) {
    const std::size_t slots = kRows * kLanes + kLanes;
    base.resize(4 * slots);
    u.resize(4 * slots);
    t.resize(4 * slots);
    x.resize(slots);
    Random random(7);
    for (std::uint32_t k = 0; k < kRows; ++k) {
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        const bool real = k < length(lane);
        slot.push_back(real ? (k * kLanes + lane) * 77 % (kRows * kLanes) : kRows * kLanes + lane);
        rows[k].rest[lane] = k + 1 < length(lane) ? 0.1f : 0.f;
        rows[k].inverse_mass[lane] =
            real && (k > 0 || lane % 3 > 0) ? static_cast<float>(random.between(0.1, 1)) : 0.f;
      }
    }
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) place(lane, random);
  }

  static std::uint32_t length(std::uint32_t lane) { return lane; }
  std::uint32_t slot_of(std::uint32_t k, std::uint32_t lane) const {
    return slot[k * kLanes + lane];
  }

  void place(std::uint32_t lane, Random& random) {
    kernels::Vector at{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    for (std::uint32_t k = 0; k < length(lane); ++k) {
      x.set(slot_of(k, lane), at);
      kernels::Vector d{1, random.between(-1, 1), random.between(-1, 1)};
      at = at + (0.1 * random.between(0.99, 1.01) / kernels::length(d)) * d;
    }
  }
  simd::Yarns yarns() { return {rows.data(), system.data(), slot.data()}; }
  simd::YarnBlock block() const { return {0, kRows}; }
  simd::Displacements quads(kernels::AlignedVector<float>& v) { return {v.data(), 1, 4}; }
  void start(const simd::Table& table) {
    table.split_positions(x.view(), quads(base), quads(u), 0, x.size());
    table.yarn_place(yarns(), block(), quads(base));
  }
  kernels::Vectors end(const simd::Table& table) {
    kernels::Vectors moved = x;
    table.join_positions(moved.view(), quads(base), quads(u), 0, x.size());
    return moved;
  }
};

/// Where one exact linear solve takes the particles of a lane.
std::vector<kernels::Vector> solved_densely(const Block& b, std::uint32_t lane) {
  const std::uint32_t particles = Block::length(lane), links = particles - 1;
  std::vector<kernels::Vector> x, n;
  std::vector<double> w;
  for (std::uint32_t k = 0; k < particles; ++k) {
    x.push_back(b.x[b.slot_of(k, lane)]);
    w.push_back(static_cast<double>(b.rows[k].inverse_mass[lane]));
  }
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(links, links);
  Eigen::VectorXd e(links);
  for (std::uint32_t k = 0; k < links; ++k) {
    const kernels::Vector d = x[k] - x[k + 1];
    n.push_back((1 / kernels::length(d)) * d);
    e[k] = kernels::length(d) - static_cast<double>(b.rows[k].rest[lane]);
    a(k, k) = w[k] + w[k + 1];
    if (k > 0) a(k, k - 1) = a(k - 1, k) = -w[k] * kernels::dot(n[k - 1], n[k]);
  }
  const Eigen::VectorXd lambda = a.ldlt().solve(e);
  for (std::uint32_t k = 0; k < links; ++k) {
    x[k] = x[k] + (-w[k] * lambda[k]) * n[k];
    x[k + 1] = x[k + 1] + (w[k + 1] * lambda[k]) * n[k];
  }
  return x;
}

TEST_CASE("positions that do not move come back from two floats to the last bit") {
  for (const simd::Isa isa : supported_isas()) {
    Block b;
    for (std::size_t i = 0; i < b.x.size(); ++i) b.x.x[i] += 1000;
    b.start(simd::table(isa));
    const kernels::Vectors back = b.end(simd::table(isa));
    for (std::size_t i = 0; i < b.x.size(); ++i) {
      CHECK(kernels::length(back[i] - b.x[i]) == 0);
    }
  }
}

TEST_CASE("a sweep over a block solves each of its yarns exactly") {
  const Block untouched;
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    Block b;
    const simd::Table& table = simd::table(isa);
    b.start(table);
    const float worst = table.yarn_sweep(b.yarns(), b.block(), b.quads(b.u), b.scratch.data());
    CHECK(worst == doctest::Approx(0.01).epsilon(0.05));
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      const auto expected = solved_densely(untouched, lane);
      for (std::uint32_t k = 0; k < Block::length(lane); ++k) {
        CHECK(kernels::length(moved[b.slot_of(k, lane)] - expected[k]) < 3e-8);
      }
    }
  }
}

TEST_CASE("what conjugate gradients are made of agrees with one exact solve") {
  const Block untouched;
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    Block b;
    const simd::Table& table = simd::table(isa);
    b.start(table);
    table.yarn_linearise(b.yarns(), b.block(), b.quads(b.u));
    // One family is its own preconditioner: the first step is the solution.
    const simd::YarnProducts before = table.yarn_precondition(b.yarns(), b.block(), 0);
    table.yarn_push(b.yarns(), b.block(), 0, b.quads(b.t));
    const float curvature = table.yarn_pull(b.yarns(), b.block(), b.quads(b.t));
    CHECK(before.product / curvature == doctest::Approx(1).epsilon(1e-5));
    CHECK(before.worst == doctest::Approx(0.01).epsilon(0.05));
    const auto after = table.yarn_precondition(b.yarns(), b.block(), before.product / curvature);
    CHECK(after.worst < 1e-6f);
    table.yarn_finish(b.yarns(), b.block(), b.quads(b.u));
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      const auto expected = solved_densely(untouched, lane);
      for (std::uint32_t k = 0; k < Block::length(lane); ++k) {
        CHECK(kernels::length(moved[b.slot_of(k, lane)] - expected[k]) < 1e-7);
      }
    }
  }
}

/// A block whose system has p, z and q of a second iteration.
Block in_conjugate_gradients(const simd::Table& table) {
  Block b;
  b.start(table);
  table.yarn_linearise(b.yarns(), b.block(), b.quads(b.u));
  table.yarn_precondition(b.yarns(), b.block(), 0);
  table.yarn_push(b.yarns(), b.block(), 0, b.quads(b.t));
  table.yarn_pull(b.yarns(), b.block(), b.quads(b.t));
  table.yarn_precondition(b.yarns(), b.block(), 0.5f);
  return b;
}

TEST_CASE(
    "pushing first, or pushing and pulling at once, is pushing onto nothing and then pulling") {
  constexpr float kBeta = 0.25f;
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    Block apart = in_conjugate_gradients(table), first = apart, together = apart;
    std::ranges::fill(apart.t, 0.f);
    std::ranges::fill(first.t, 7.f);
    std::ranges::fill(together.t, 0.f);
    table.yarn_push(apart.yarns(), apart.block(), kBeta, apart.quads(apart.t));
    table.yarn_push_first(first.yarns(), first.block(), kBeta, first.quads(first.t));
    const float product =
        table.yarn_push_pull(together.yarns(), together.block(), kBeta, together.quads(together.t));
    for (const std::uint32_t slot : apart.slot) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        CHECK(first.t[4 * slot + axis] == apart.t[4 * slot + axis]);
        CHECK(together.t[4 * slot + axis] == apart.t[4 * slot + axis]);
      }
    }
    CHECK(product == table.yarn_pull(apart.yarns(), apart.block(), apart.quads(apart.t)));
    CHECK(product > 0);
    for (std::uint32_t k = 0; k < Block::kRows; ++k) {
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        CHECK(together.system[k].p[lane] == apart.system[k].p[lane]);
        CHECK(first.system[k].p[lane] == apart.system[k].p[lane]);
        CHECK(together.system[k].q[lane] == apart.system[k].q[lane]);
      }
    }
  }
}

TEST_CASE("yarns: AVX2 and AVX-512 give the same bits") {
  if (!simd::supported(simd::Isa::avx512)) return;
  std::vector<std::vector<float>> results;
  for (const simd::Isa isa : {simd::Isa::avx2, simd::Isa::avx512}) {
    Block b;
    const simd::Table& table = simd::table(isa);
    b.start(table);
    table.yarn_sweep(b.yarns(), b.block(), b.quads(b.u), b.scratch.data());
    table.yarn_linearise(b.yarns(), b.block(), b.quads(b.u));
    const auto p = table.yarn_precondition(b.yarns(), b.block(), 0);
    results.emplace_back(b.u.begin(), b.u.end());
    results.back().push_back(p.product);
    results.back().push_back(p.worst);
  }
  CHECK(results[0] == results[1]);
}

TEST_CASE("a straight yarn between two fixed ends, which no impulse can shorten, stays finite") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    Block b;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      for (std::uint32_t k = 0; k < Block::length(lane); ++k) {
        b.x.set(b.slot_of(k, lane), {0.09 * k, 0, 0});
        const bool end = k == 0 || k + 1 == Block::length(lane);
        b.rows[k].inverse_mass[lane] = end ? 0.f : 1.f;
      }
    }
    const simd::Table& table = simd::table(isa);
    b.start(table);
    table.yarn_sweep(b.yarns(), b.block(), b.quads(b.u), b.scratch.data());
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      for (std::uint32_t k = 0; k < Block::length(lane); ++k) {
        CHECK(kernels::length(moved[b.slot_of(k, lane)]) < 2);
      }
    }
  }
}

}  // namespace
}  // namespace weft::test
