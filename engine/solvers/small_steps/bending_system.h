/// The linear system of bending: the displacement x by which the law of all bending elements holds
/// (bending_frame.h),
///
///     A x = b,   A = inertia M + stiffness K,
///
/// where b is the force of the elements on the predicted positions (bending_rows.h). A is constant
/// and positive, and the same for x, y and z. Conjugate gradients solve it from a guess, with one
/// of two preconditioners:
///
///   diagonal   that of A: cloth that is soft in a substep takes a few steps
///   factor     a sparse factorisation (bending_factor.h) of that of nearly the same substep: two
///              or three steps, however stiff; in double alone
///
/// By a factorisation of A itself one step is the solution, but for rounding: what is left is
/// measured in the norm of the diagonal, which takes no second one.
///
/// Vectors have four numbers for each slot. A vector of what is fixed is 0. Results do not depend
/// on the number of threads. Nothing is allocated once every preconditioner has been made that the
/// substeps ask for.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/bending_factor.h"
#include "engine/solvers/small_steps/bending_rows.h"

namespace weft {

/// When a solution is good enough.
struct BendingLimits {
  double part = 0;    // of the force, in the norm of the preconditioner, that may be left
  double weight = 0;  // of what else acts, in that norm squared: a force counts as at least that
  int most_steps = 1;
};

template <class Real>
class BendingSystem {
 public:
  BendingSystem(const BendingRows& rows, const simd::Table& table);

  /// Allocates the memory of a solution. Else the first preparation does it.
  void allocate();
  const Real* values() const;
  /// Solutions by this law, or nearly so, are to come.
  void prepare_diagonal(const BendingLaw& law);
  /// exactly: by this very law.
  void prepare_factor(const BendingFronts& fronts, const BendingLaw& law,
                      bool exactly) requires std::is_same_v<Real, double>;

  /// The last solution, or 0 if there is none.
  Real* guess() { return guess_.data(); }
  void forget_guess() { std::ranges::fill(guess_, Real{0}); }
  /// b - stiffness K guess, to be written before a solution; in its end what is left.
  Real* residual() { return residual_.data(); }
  /// Solves within the limits. Returns which share of the force is left, in the norm of the
  /// preconditioner.
  double solve(const BendingLaw& law, const BendingLimits& limits, Team& team);
  /// x - guess; unwritten where no steps were taken.
  const Real* change() const { return change_.data(); }
  int steps() const { return steps_; }

  std::size_t bytes() const;

 private:
  /// p. Numbers that a product reads before it and after it are 0.
  Real* direction() { return direction_.data() + kAround; }
  simd::BendingGradients<Real> gradients();
  template <class Result, class Work>
  Result sum(Team& team, std::vector<Result>& parts, Work&& work) const;
  template <class Work>
  double sum(Team& team, Work&& work) {
    return sum(team, sums_, work);
  }
  template <class Work>
  void for_slots(Team& team, Work&& work) const;
  double precondition(Team& team);
  void turn(double beta, Team& team);
  simd::BendingNorms begin(const simd::BendingMatrix<Real>& a, Team& team);
  double multiply(const simd::BendingMatrix<Real>& a, Team& team);
  double step(double by, Team& team);
  double solve_exactly(const simd::BendingMatrix<Real>& a, const BendingLimits& limits, Team& team);

  /// One that has been made, for substeps of nearly this length.
  struct Factor {
    BendingLaw law{};
    std::uint64_t used = 0;
    std::unique_ptr<BendingFactor> factor;
  };

  static constexpr std::size_t kAround = 16;  // numbers

  const BendingRows& rows_;
  const simd::Table& table_;
  BendingLaw prepared_;
  kernels::AlignedVector<Real> guess_, change_, residual_, direction_, product_;
  kernels::AlignedVector<Real> reciprocal_;  // per slot
  std::vector<double> sums_;                 // per range
  std::vector<simd::BendingNorms> norms_;
  kernels::AlignedVector<double> z_;       // the residual, preconditioned
  kernels::AlignedVector<double> values_;  // of rows by groups, where these are doubles
  std::vector<Factor> made_;
  Factor* factor_ = nullptr;  // or null: the diagonal
  std::uint64_t uses_ = 0;
  int steps_ = 0;
};

}  // namespace weft
