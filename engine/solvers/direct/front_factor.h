/// The factorisation A = L D L^T on fixed fronts (engine/solvers/direct/direct_fronts.h). A front
/// is the sum of the matrix entries in its columns and the updates of its children. It is
/// eliminated as a dense matrix (kernels/simd/fronts.h), and its own update goes to its parent.
/// Nothing is allocated after construction.
#pragma once

#include <cstddef>

#include "engine/solvers/direct/direct_fronts.h"
#include "kernels/simd/table.h"
#include "kernels/vectors.h"

namespace weft {

class FrontFactor {
 public:
  FrontFactor(const DirectFronts& fronts, const simd::Table& kernels);

  /// The number that a pivot of the column must exceed, or it is taken as infinite; at first 0.
  double& least(const DirectFront& front, std::size_t column) {
    return least_[front.column + column];
  }
  /// The value of an entry (DirectFronts::place_of()).
  double& at(std::size_t place) { return lower_[place]; }
  /// For each front, in their order: clear(), then its entries are written, then eliminate().
  void clear(std::size_t front);
  void eliminate(std::size_t front);
  /// Replaces b by A^-1 b.
  void solve(double* b);
  /// The same of three right sides, four numbers for each row, of which the last is idle.
  void solve_vectors(double* b);
  std::size_t bytes() const;

 private:
  simd::Front front_at(std::size_t i);
  void add_update(const DirectFront& child, std::size_t number, const simd::Front& parent) const;

  const DirectFronts& fronts_;
  const simd::Table& kernels_;
  kernels::AlignedVector<double> lower_;               // the panels of all fronts
  kernels::AlignedVector<double> reciprocal_, least_;  // per padded column
  kernels::AlignedVector<double> updates_[2];          // stacks of even and odd levels
  kernels::AlignedVector<double> scratch_, part_;      // for a panel; for right sides
};

}  // namespace weft
