/// The factorisation A = L D L^T of a symmetric sparse matrix, in its own order. The matrix need
/// not be positive, but no pivot may vanish. The pattern of L is found once; later factorisations
/// allocate nothing.
///
/// It goes row by row: a row of A less the contributions of the rows before is the row of L times
/// D (T. A. Davis, "Direct Methods for Sparse Linear Systems", 2006, section 4.7).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace weft {

/// The upper triangle with its diagonal, column by column; rows are ascending.
struct SparsePattern {
  std::vector<int> column_begin, rows;
  int size() const { return static_cast<int>(column_begin.size()) - 1; }
};

/// L below its diagonal of ones.
struct FactorPattern {
  std::vector<int> column_begin, rows;  // column by column; rows are ascending
  std::vector<int> row_begin, columns;  // the same row by row
  std::vector<int> place;               // of those in the order of the columns
  std::size_t bytes() const;
};

FactorPattern find_factor_pattern(const SparsePattern& matrix);

class LinkageFactor {
 public:
  /// Both must outlive it.
  LinkageFactor(const SparsePattern& matrix, const FactorPattern& pattern);

  /// values: in the order of the matrix' rows. Returns whether no pivot vanished.
  bool factorise(std::span<const double> values);
  /// After that: x becomes the solution of A x' = x.
  void solve(std::span<double> x) const;
  std::size_t bytes() const;

 private:
  const SparsePattern& matrix_;
  const FactorPattern& pattern_;
  std::vector<double> lower_;  // L, in the order of its columns
  std::vector<double> pivot_;  // D
  std::vector<double> row_;    // scratch; 0 between two rows
};

}  // namespace weft
