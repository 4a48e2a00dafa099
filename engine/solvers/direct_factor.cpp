#include "engine/solvers/direct_factor.h"

namespace weft {

void DirectFactor::eliminate(std::size_t k, double diagonal) {
  double pivot = diagonal + kShift * layout_.diagonal[k];
  double* const y = work_.data();
  const std::uint32_t* const column_row = layout_.column_row.data();
  for (std::size_t i = layout_.pattern_begin[k]; i < layout_.pattern_begin[k + 1]; ++i) {
    const std::size_t j = layout_.pattern_column[i];
    const double yj = y[j];
    y[j] = 0;
    const std::size_t end = end_[j]++;
    for (std::size_t e = layout_.column_begin[j]; e < end; ++e) y[column_row[e]] -= lower_[e] * yj;
    const double l = yj * reciprocal_[j];
    lower_[end] = l;
    pivot -= l * yj;
  }
  reciprocal_[k] = pivot > kLeastPivot * layout_.diagonal[k] ? 1 / pivot : 0;
}

void DirectFactor::solve(double* b) const {
  const std::size_t rows = layout_.rows();
  const auto& begin = layout_.column_begin;
  const std::uint32_t* const row = layout_.column_row.data();
  for (std::size_t j = 0; j < rows; ++j) {
    const double bj = b[j];
    for (std::size_t e = begin[j]; e < begin[j + 1]; ++e) b[row[e]] -= lower_[e] * bj;
  }
  for (std::size_t j = rows; j-- > 0;) {
    double sum = b[j] * reciprocal_[j];
    for (std::size_t e = begin[j]; e < begin[j + 1]; ++e) sum -= lower_[e] * b[row[e]];
    b[j] = sum;
  }
}

std::size_t DirectFactor::bytes() const {
  return sizeof(double) * (lower_.capacity() + reciprocal_.capacity() + work_.capacity()) +
         sizeof(std::size_t) * end_.capacity();
}

}  // namespace weft
