/// A = L D L^T on the fixed pattern of a DirectLayout, row by row (up-looking): row k of L solves a
/// triangular system with the rows above it,
///
///     L(0..k-1, 0..k-1) D y = A(0..k-1, k),     L(k, j) = y_j,     d_k = A(k, k) - sum_j d_j y_j^2
///
/// and only the columns of its pattern take part. Nothing is allocated after construction.
///
/// Redundant constraints make A singular: the pivot of the last of them vanishes but for rounding.
/// The diagonal w_a + w_b is raised by kShift of itself, which the outer iteration corrects with
/// its next direction update; and a pivot that is hardly more than that (kLeastPivot) belongs to a
/// constraint that the others imply already: its impulse is taken as 0.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/solvers/direct_layout.h"

namespace weft {

class DirectFactor {
 public:
  static constexpr double kShift = 1e-12;
  static constexpr double kLeastPivot = 1e-11;

  explicit DirectFactor(const DirectLayout& layout)
      : layout_(layout),
        lower_(layout.column_row.size()),
        reciprocal_(layout.rows()),
        end_(layout.rows()),
        work_(layout.rows()) {}

  /// row(k, y) adds A(k, j) to y[j] for all j < k and returns A(k, k).
  template <class Row>
  void factorise(Row&& row) {
    for (std::size_t k = 0; k < layout_.rows(); ++k) {
      end_[k] = layout_.column_begin[k];
      eliminate(k, row(k, work_.data()));
    }
  }
  /// b = A^-1 b.
  void solve(double* b) const;
  std::size_t bytes() const;

 private:
  void eliminate(std::size_t k, double diagonal);

  const DirectLayout& layout_;
  std::vector<double> lower_;       // by columns
  std::vector<double> reciprocal_;  // 1 / d, or 0
  std::vector<std::size_t> end_;    // of the part of each column that is known
  std::vector<double> work_;        // zero between rows
};

}  // namespace weft
