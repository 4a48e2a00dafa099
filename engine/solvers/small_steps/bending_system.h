/// The linear system of bending in a substep: the displacement x by which the force of all bending
/// elements holds in its end,
///
///     A x = r,   A = M / (b h)^2 + s K,
///
/// where r is the force of the elements on the predicted positions (bending_rows.h). A is constant
/// and positive, and the same for x, y and z. Conjugate gradients solve it with one of two
/// preconditioners:
///
///   diagonal   that of A: cloth that is soft in a substep takes a few steps
///   factor     a sparse factorisation (bending_factor.h) of A, or of that of nearly the same
///              substep: a step or two, however stiff
///
/// Vectors are in double, four numbers for each slot. A vector of what is fixed is 0. Results do
/// not depend on the number of threads. Nothing is allocated once every preconditioner has been
/// made that the substeps ask for.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/bending_factor.h"
#include "engine/solvers/small_steps/bending_rows.h"

namespace weft {

enum class BendingMethod : std::uint8_t { diagonal, factor };

class BendingSystem {
 public:
  BendingSystem(const BendingRows& rows, const simd::Table& table);

  /// Substeps of this inertia, 1 / (b h)^2, or nearly so, are to come. stiffness: s.
  void prepare_diagonal(double inertia, double stiffness);
  void prepare_factor(const BendingFronts& fronts, double inertia, double stiffness);

  /// r, to be written before a solution; in its end what is left.
  double* residual() { return residual_.data(); }
  const double* solution() const { return x_.data(); }
  /// Solves until r . P r, P the preconditioner, is at most `part` squared of what it was in the
  /// beginning, or at most `least`, in at most so many steps. inertia: of this substep. Returns the
  /// root of what is left of r . P r, as a share; 0 where it is at most `least`.
  double solve(double inertia, double part, double least, int most_iterations, Team& team);

  int iterations() const { return iterations_; }
  std::size_t bytes() const;

 private:
  simd::BendingGradients gradients();
  template <class Work>
  double sum(Team& team, Work&& work) const;
  double precondition(Team& team);
  bool is_prepared(BendingMethod method, double inertia, double stiffness) const {
    return method == method_ && inertia == inertia_ && stiffness == stiffness_;
  }

  /// One that has been made, for substeps of nearly this length.
  struct Factor {
    double inertia = 0, stiffness = 0;
    std::uint64_t used = 0;
    std::unique_ptr<BendingFactor> factor;
  };

  const BendingRows& rows_;
  const simd::Table& table_;
  BendingMethod method_ = BendingMethod::diagonal;
  double inertia_ = 0, stiffness_ = 1;  // what is prepared
  kernels::AlignedVector<double> x_, residual_, direction_, product_, z_;
  mutable std::vector<double> sums_;           // per range
  kernels::AlignedVector<double> reciprocal_;  // per slot
  std::vector<Factor> made_;
  BendingFactor* factor_ = nullptr;
  std::uint64_t uses_ = 0;
  int iterations_ = 0;
};

}  // namespace weft
