/// The factorisation A = L D L^T on the fixed fronts of a DirectLayout. A front is the sum of the
/// matrix entries in its columns and the updates of its children. It is eliminated as a dense
/// matrix (kernels/simd/fronts.h), and its own update goes to its parent. Nothing is allocated
/// after construction.
///
/// Redundant constraints make A singular: the pivot of the last of them vanishes up to rounding.
/// The diagonal w_a + w_b is therefore raised by the share kShift, which the outer iteration
/// corrects when it renews directions. A pivot that is hardly larger than that (kLeastPivot)
/// belongs to a constraint that the others imply, and its impulse is taken as 0.
#pragma once

#include <cstddef>

#include "engine/solvers/direct/direct_layout.h"
#include "kernels/simd/table.h"
#include "kernels/vectors.h"

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
      clear(i);
      for (std::size_t e = layout_.entry_begin[i]; e < layout_.entry_begin[i + 1]; ++e) {
        lower_[layout_.entry_place[e]] = entry(e);
      }
      const DirectFront& front = layout_.fronts.fronts[i];
      for (std::size_t c = 0; c < front.count; ++c) {
        const std::size_t k = front.first + c;
        lower_[front.panel + c * front.stride() + c] = diagonal(k) + kShift * layout_.diagonal[k];
      }
      eliminate(i);
    }
  }
  /// Replaces b by A^-1 b.
  void solve(double* b);
  std::size_t bytes() const;

 private:
  simd::Front front_at(std::size_t i);
  void clear(std::size_t i);
  void eliminate(std::size_t i);
  void add_update(const DirectFront& child, std::size_t number, const simd::Front& parent) const;

  const DirectLayout& layout_;
  const simd::Table& kernels_;
  kernels::AlignedVector<double> lower_;               // the panels of all fronts
  kernels::AlignedVector<double> reciprocal_, least_;  // per padded column
  kernels::AlignedVector<double> updates_[2];          // stacks of even and odd levels
  kernels::AlignedVector<double> scratch_, part_;      // for a panel; for a right side
};

}  // namespace weft
