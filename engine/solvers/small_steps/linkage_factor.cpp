#include "engine/solvers/small_steps/linkage_factor.h"

#include <algorithm>
#include <numeric>

#include "engine/bytes_of.h"

namespace weft {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The columns of each row of L. Row k has an entry in column i where row k of A has one, or a
/// column whose first entry below the diagonal is in row i, its parent, has one.
void find_rows(const SparsePattern& matrix, FactorPattern& pattern) {
  std::vector<int> parent(at(matrix.size()), -1), seen_by(at(matrix.size()), -1);
  pattern.row_begin = {0};
  for (int k = 0; k < matrix.size(); ++k) {
    seen_by[at(k)] = k;
    for (int entry = matrix.column_begin[at(k)]; entry < matrix.column_begin[at(k + 1)]; ++entry) {
      for (int i = matrix.rows[at(entry)]; seen_by[at(i)] != k; i = parent[at(i)]) {
        if (parent[at(i)] < 0) parent[at(i)] = k;
        seen_by[at(i)] = k;
        pattern.columns.push_back(i);
      }
    }
    std::sort(pattern.columns.begin() + pattern.row_begin.back(), pattern.columns.end());
    pattern.row_begin.push_back(static_cast<int>(pattern.columns.size()));
  }
}

void find_columns(FactorPattern& pattern) {
  const std::size_t size = pattern.row_begin.size() - 1;
  pattern.column_begin.assign(size + 1, 0);
  for (const int column : pattern.columns) ++pattern.column_begin[at(column) + 1];
  std::partial_sum(pattern.column_begin.begin(), pattern.column_begin.end(),
                   pattern.column_begin.begin());
  std::vector<int> next(pattern.column_begin.begin(), pattern.column_begin.end() - 1);
  pattern.rows.resize(pattern.columns.size());
  for (std::size_t k = 0; k < size; ++k) {
    for (int entry = pattern.row_begin[k]; entry < pattern.row_begin[k + 1]; ++entry) {
      const int place = next[at(pattern.columns[at(entry)])]++;
      pattern.rows[at(place)] = static_cast<int>(k);
      pattern.place.push_back(place);
    }
  }
}

}  // namespace

FactorPattern find_factor_pattern(const SparsePattern& matrix) {
  FactorPattern pattern;
  find_rows(matrix, pattern);
  find_columns(pattern);
  return pattern;
}

std::size_t FactorPattern::bytes() const {
  return bytes_of(column_begin) + bytes_of(rows) + bytes_of(row_begin) + bytes_of(columns) +
         bytes_of(place);
}

LinkageFactor::LinkageFactor(const SparsePattern& matrix, const FactorPattern& pattern)
    : matrix_(matrix),
      pattern_(pattern),
      lower_(pattern.rows.size()),
      pivot_(pattern.row_begin.empty() ? 0 : pattern.row_begin.size() - 1),
      row_(pivot_.size()) {}

bool LinkageFactor::factorise(std::span<const double> values) {
  for (std::size_t k = 0; k < pivot_.size(); ++k) {
    for (int entry = matrix_.column_begin[k]; entry < matrix_.column_begin[k + 1]; ++entry)
      row_[at(matrix_.rows[at(entry)])] = values[at(entry)];
    double pivot = row_[k];
    row_[k] = 0;
    for (int entry = pattern_.row_begin[k]; entry < pattern_.row_begin[k + 1]; ++entry) {
      const std::size_t i = at(pattern_.columns[at(entry)]);
      const int place = pattern_.place[at(entry)];
      const double left = row_[i];
      row_[i] = 0;
      for (int p = pattern_.column_begin[i]; p < place; ++p)
        row_[at(pattern_.rows[at(p)])] -= lower_[at(p)] * left;
      const double l = left / pivot_[i];
      lower_[at(place)] = l;
      pivot -= l * left;
    }
    if (pivot == 0) return false;
    pivot_[k] = pivot;
  }
  return true;
}

void LinkageFactor::solve(std::span<double> x) const {
  for (std::size_t i = 0; i < pivot_.size(); ++i) {
    for (int p = pattern_.column_begin[i]; p < pattern_.column_begin[i + 1]; ++p)
      x[at(pattern_.rows[at(p)])] -= lower_[at(p)] * x[i];
  }
  for (std::size_t i = pivot_.size(); i-- > 0;) {
    x[i] /= pivot_[i];
    for (int p = pattern_.column_begin[i]; p < pattern_.column_begin[i + 1]; ++p)
      x[i] -= lower_[at(p)] * x[at(pattern_.rows[at(p)])];
  }
}

std::size_t LinkageFactor::bytes() const {
  return bytes_of(lower_) + bytes_of(pivot_) + bytes_of(row_);
}

}  // namespace weft
