/// The sparse factorisation against the matrix that it is of.
#include "engine/solvers/small_steps/linkage_factor.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/random.h"

namespace weft::test::engine_solvers_small_steps_linkage_factor {
namespace {

/// A symmetric matrix with a dense upper triangle to compare with.
struct Matrix {
  SparsePattern pattern;
  std::vector<double> values;
  std::vector<std::vector<double>> dense;
};

/// Every third row is one of a multiplier: its pivot is negative.
Matrix random_matrix(Random& random, int size, double share) {
  Matrix m;
  m.dense.assign(static_cast<std::size_t>(size),
                 std::vector<double>(static_cast<std::size_t>(size)));
  m.pattern.column_begin = {0};
  for (int column = 0; column < size; ++column) {
    for (int row = 0; row <= column; ++row) {
      if (row < column && random.between(0, 1) > share) continue;
      const double value = row < column ? random.between(-1, 1) : column % 3 == 2 ? -9.0 : 9.0;
      m.pattern.rows.push_back(row);
      m.values.push_back(value);
      m.dense[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = value;
      m.dense[static_cast<std::size_t>(column)][static_cast<std::size_t>(row)] = value;
    }
    m.pattern.column_begin.push_back(static_cast<int>(m.pattern.rows.size()));
  }
  return m;
}

TEST_CASE("a solution is one of the matrix, again and again") {
  Random random(1);
  for (const int size : {1, 2, 7, 40}) {
    for (const double share : {0.0, 0.1, 1.0}) {
      Matrix m = random_matrix(random, size, share);
      const FactorPattern pattern = find_factor_pattern(m.pattern);
      LinkageFactor factor(m.pattern, pattern);
      for (int repeat = 0; repeat < 3; ++repeat) {
        std::vector<double> x;
        for (int i = 0; i < size; ++i) x.push_back(random.between(-1, 1));
        const std::vector<double> asked = x;
        REQUIRE(factor.factorise(m.values));
        factor.solve(x);
        for (std::size_t row = 0; row < x.size(); ++row) {
          double sum = 0;
          for (std::size_t column = 0; column < x.size(); ++column)
            sum += m.dense[row][column] * x[column];
          CHECK(std::abs(sum - asked[row]) < 1e-12);
        }
      }
    }
  }
}

TEST_CASE("a chain fills nothing in") {
  SparsePattern chain;
  for (int column = 0; column < 100; ++column) {
    chain.column_begin.push_back(static_cast<int>(chain.rows.size()));
    if (column > 0) chain.rows.push_back(column - 1);
    chain.rows.push_back(column);
  }
  chain.column_begin.push_back(static_cast<int>(chain.rows.size()));
  CHECK(find_factor_pattern(chain).rows.size() == 99);
}

TEST_CASE("a pivot that vanishes is told") {
  const SparsePattern two{{0, 1, 3}, {0, 0, 1}};
  const FactorPattern pattern = find_factor_pattern(two);
  LinkageFactor factor(two, pattern);
  CHECK_FALSE(factor.factorise(std::vector{1.0, 1.0, 1.0}));
  CHECK(factor.factorise(std::vector{1.0, 1.0, 2.0}));
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_linkage_factor
