/// The factorisation of the direct solver's matrix, on the fronts of a DirectLayout.
///
/// Redundant constraints make A singular: the pivot of the last of them vanishes up to rounding.
/// The diagonal w_a + w_b is therefore raised by the share kShift, which the outer iteration
/// corrects when it renews directions. A pivot that is hardly larger than that (kLeastPivot)
/// belongs to a constraint that the others imply, and its impulse is taken as 0.
#pragma once

#include <cstddef>

#include "engine/solvers/direct/direct_layout.h"
#include "engine/solvers/direct/front_factor.h"

namespace weft {

class DirectFactor {
 public:
  static constexpr double kShift = 1e-12;
  static constexpr double kLeastPivot = 1e-11;

  DirectFactor(const DirectLayout& layout, const simd::Table& kernels);

  /// entry(e) returns the value of entry e of the layout, and diagonal(k) returns A(k, k).
  template <class Entry, class Diagonal>
  void factorise(Entry&& entry, Diagonal&& diagonal) {
    for (std::size_t i = 0; i < layout_.fronts.fronts.size(); ++i) {
      factor_.clear(i);
      for (std::size_t e = layout_.entry_begin[i]; e < layout_.entry_begin[i + 1]; ++e) {
        factor_.at(layout_.entry_place[e]) = entry(e);
      }
      const DirectFront& front = layout_.fronts.fronts[i];
      for (std::size_t c = 0; c < front.count; ++c) {
        const std::size_t k = front.first + c;
        factor_.at(front.panel + c * front.stride() + c) =
            diagonal(k) + kShift * layout_.diagonal[k];
      }
      factor_.eliminate(i);
    }
  }
  /// Replaces b by A^-1 b.
  void solve(double* b) { factor_.solve(b); }
  std::size_t bytes() const { return factor_.bytes(); }

 private:
  const DirectLayout& layout_;
  FrontFactor factor_;
};

}  // namespace weft
