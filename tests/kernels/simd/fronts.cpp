/// Dense fronts against dense matrices.
#include <doctest/doctest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/simd/table.h"
#include "kernels/vectors.h"
#include "tests/support/dense.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"

namespace weft::test::kernels_simd_fronts {
namespace {

using kernels::AlignedVector;

std::size_t padded(std::size_t n, std::size_t to) { return (n + to - 1) / to * to; }

/// A front of `count` columns with `below` rows below them, of a random positive definite matrix;
/// one column without a pivot, if any.
struct RandomFront {
  std::size_t count, rows_below, triangle, below;
  Eigen::MatrixXd matrix;
  AlignedVector<double> panel, update, least, reciprocal, scratch;

  RandomFront(std::size_t count, std::size_t rows_below, std::uint32_t seed)
      : count(count),
        rows_below(rows_below),
        triangle(padded(count, simd::kFrontRows)),
        below(padded(rows_below, simd::kFrontRows)),
        panel(padded(count, 4) * (triangle + below)),
        update(below * below),
        least(padded(count, 4), 1e-9),
        reciprocal(padded(count, 4)),
        scratch(panel.size()) {
    const auto size = static_cast<Eigen::Index>(count + rows_below);
    Random random(seed);
    const Eigen::MatrixXd half =
        Eigen::MatrixXd::NullaryExpr(size, size, [&] { return random.between(-1, 1); });
    const Eigen::MatrixXd transposed = half.transpose();
    matrix = product(half, transposed) + Eigen::MatrixXd::Identity(size, size);
    for (std::size_t j = 0; j < count + rows_below; ++j) {
      for (std::size_t i = j; i < count + rows_below; ++i) at(i, j) = value(i, j);
    }
  }
  double value(std::size_t i, std::size_t j) const {
    return matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  std::size_t row(std::size_t i) const { return i < count ? i : triangle + i - count; }
  double& at(std::size_t i, std::size_t j) {
    return j < count ? panel[j * (triangle + below) + row(i)]
                     : update[(j - count) * below + i - count];
  }
  simd::Front front() {
    return {padded(count, 4), triangle + below,  below,         panel.data(), update.data(),
            least.data(),     reciprocal.data(), scratch.data()};
  }
};

constexpr std::pair<std::size_t, std::size_t> kSizes[]{{1, 0},  {1, 1},   {3, 20}, {4, 8},
                                                       {9, 31}, {17, 70}, {64, 3}, {40, 0}};

TEST_CASE("a front is eliminated as the dense matrix is") {
  for (const simd::Isa isa : supported_isas()) {
    for (const auto& [count, below] : kSizes) {
      CAPTURE(count);
      CAPTURE(below);
      RandomFront f(count, below, 7);
      simd::table(isa).eliminate_front(f.front());
      const auto n = static_cast<Eigen::Index>(count), m = static_cast<Eigen::Index>(below);
      const Eigen::MatrixXd a = f.matrix.topLeftCorner(n, n), b = f.matrix.bottomLeftCorner(m, n);
      const Eigen::MatrixXd across = b.transpose();
      const Eigen::MatrixXd left = f.matrix.bottomRightCorner(m, m) - product(b, solved(a, across));
      const double scale = f.matrix.norm();
      for (std::size_t j = 0; j < below; ++j) {
        for (std::size_t i = j; i < below; ++i) {
          const double expected = left(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
          CHECK(std::abs(f.update[j * f.below + i] - expected) <= 1e-13 * scale);
        }
      }
    }
  }
}

TEST_CASE("substitutions with a front solve its system") {
  for (const simd::Isa isa : supported_isas()) {
    for (const auto& [count, below] : kSizes) {
      CAPTURE(count);
      RandomFront f(count, below, 11);
      Random random(3);
      Eigen::VectorXd right(static_cast<Eigen::Index>(count));
      AlignedVector<double> z(f.triangle + f.below);
      for (std::size_t i = 0; i < count; ++i) {
        z[i] = right[static_cast<Eigen::Index>(i)] = random.between(-1, 1);
      }
      const simd::Table& table = simd::table(isa);
      table.eliminate_front(f.front());
      table.solve_front_forward(f.front(), z.data());
      std::fill(z.begin() + static_cast<std::ptrdiff_t>(f.triangle), z.end(), 0.0);
      table.solve_front_backward(f.front(), z.data());
      const auto n = static_cast<Eigen::Index>(count);
      const Eigen::VectorXd expected = solved(f.matrix.topLeftCorner(n, n), right);
      for (std::size_t i = 0; i < count; ++i) {
        CHECK(std::abs(z[i] - expected[static_cast<Eigen::Index>(i)]) <= 1e-12 * right.norm());
      }
    }
  }
}

// The second of two equal rows has nothing left for a pivot.
TEST_CASE("a pivot that is no larger than allowed counts as infinite") {
  for (const simd::Isa isa : supported_isas()) {
    RandomFront f(6, 5, 13);
    for (std::size_t i = 0; i < 11; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      f.matrix(3, k) = f.matrix(k, 3) = f.matrix(i == 3 ? 2 : k, 2);
    }
    for (std::size_t j = 0; j < 11; ++j) {
      for (std::size_t i = j; i < 11; ++i) f.at(i, j) = f.value(i, j);
    }
    simd::table(isa).eliminate_front(f.front());
    CHECK(f.reciprocal[3] == 0);
    for (std::size_t i = 4; i < 11; ++i) CHECK(f.at(i, 3) == 0);
    CHECK(f.reciprocal[2] > 0);
    CHECK(f.reciprocal[4] > 0);
  }
}

TEST_CASE("avx2 and avx512 give the same bits") {
  if (!simd::supported(simd::Isa::avx512)) return;
  for (const auto& [count, below] : kSizes) {
    RandomFront one(count, below, 17), other(count, below, 17);
    AlignedVector<double> z(one.triangle + one.below, 0.3), y = z;
    const auto go = [](simd::Isa isa, RandomFront& f, AlignedVector<double>& b) {
      simd::table(isa).eliminate_front(f.front());
      simd::table(isa).solve_front_forward(f.front(), b.data());
      simd::table(isa).solve_front_backward(f.front(), b.data());
    };
    go(simd::Isa::avx2, one, z);
    go(simd::Isa::avx512, other, y);
    CHECK(std::equal(z.begin(), z.end(), y.begin()));
    CHECK(std::equal(one.panel.begin(), one.panel.end(), other.panel.begin()));
    for (std::size_t j = 0; j < below; ++j) {
      for (std::size_t i = j; i < below; ++i) {
        CHECK(one.update[j * one.below + i] == other.update[j * other.below + i]);
      }
    }
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_fronts
