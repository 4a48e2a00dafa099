/// A = L D L^T on the fixed fronts of a DirectLayout. A front is assembled from the matrix's
/// entries in its columns and from what its children pass on, eliminated densely
/// (kernels/simd/fronts.h), and passes on an update itself. Nothing is allocated after
/// construction.
///
/// Redundant constraints make A singular: the pivot of the last of them vanishes but for rounding.
/// The diagonal w_a + w_b is raised by kShift of itself, which the outer iteration corrects with
/// its next direction update; and a pivot that is hardly more than that (kLeastPivot) belongs to a
/// constraint that the others imply already: its impulse is taken as 0.
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

  /// entry(e): the value of entry e of the layout; diagonal(k): A(k, k).
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
  /// b = A^-1 b.
  void solve(double* b);
  std::size_t bytes() const;

 private:
  simd::Front front_at(std::size_t i);
  void clear(std::size_t i);
  void eliminate(std::size_t i);
  void add_update(const DirectFront& child, std::size_t number, const simd::Front& parent) const;

  const DirectLayout& layout_;
  const simd::Table& kernels_;
  kernels::AlignedVector<double> lower_;               // panels
  kernels::AlignedVector<double> reciprocal_, least_;  // per padded column
  kernels::AlignedVector<double> updates_[2];          // stacks
  kernels::AlignedVector<double> scratch_, part_;      // of a panel; of a right side
};

}  // namespace weft
