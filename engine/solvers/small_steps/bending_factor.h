/// The sparse factorisation of the matrix of bending, inertia M + stiffness K, on fronts
/// (engine/solvers/direct/front_factor.h).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/solvers/direct/front_factor.h"
#include "engine/solvers/small_steps/bending_rows.h"

namespace weft {

/// Data that depend on the pattern of K alone.
struct BendingFronts {
  std::vector<std::uint32_t> slots;        // per row, in the order of elimination
  std::vector<std::size_t> entry_begin;    // per front, and the end of the last
  std::vector<std::size_t> entry_place;    // FrontFactor::at()
  std::vector<std::uint32_t> entry_value;  // index in BendingRows::values
  DirectFronts fronts;

  std::size_t bytes() const;
};

BendingFronts make_bending_fronts(const BendingRows& rows);

class BendingFactor {
 public:
  BendingFactor(const BendingRows& rows, const BendingFronts& fronts, const simd::Table& kernels);

  void factorise(const BendingLaw& law);
  /// z = A^-1 r, four numbers for each slot; those of what is fixed stay as they are.
  void solve(const double* r, double* z);
  std::size_t bytes() const;

 private:
  const BendingRows& rows_;
  const BendingFronts& fronts_;
  FrontFactor factor_;
  kernels::AlignedVector<double> right_;  // in the order of elimination
};

}  // namespace weft
