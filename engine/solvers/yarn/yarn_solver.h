/// The yarn solver, which solves whole chains of constraints at a time.
///
/// A sweep solves the yarns of each family, one family after the other, until their own errors are
/// small. Within a block of kLanes yarns this is Newton's method, with directions and errors
/// renewed in each iteration; between families it is block Gauss-Seidel
/// (kernels/simd/yarn_elimination.h). The constraints of no yarn (ropes, hubs, contacts) follow one
/// by one, with their accumulated impulses clamped. Every block minimises the same convex quadratic
/// function of the impulses, 1/2 l'Al - e'l, over its own impulses with all others held. Along
/// fixed directions a pass therefore never raises it, which is why the iteration converges.
///
/// Where sweeps converge too slowly, Newton's method takes over with one linear system for all
/// yarns: the first family is eliminated, and the others are solved by conjugate gradients with the
/// tridiagonal matrices of their yarns as preconditioner (kernels/simd/yarn_system.h).
///
/// The constraints are linear in the velocities, so that one such system corrects these.
///
/// A spring gives way to what its impulses have come to (kernels/simd/yarn_elimination.h); its
/// error is that of its law, by double positions and the sum of its impulses.
///
/// Errors are measured in double after each sweep, or after every second one while they are large;
/// a Newton step is followed by a sweep. If the errors do not fall, the solver gives up early and
/// leaves the answer to its caller.
#pragma once

#include <weft/weft.h>

#include <algorithm>
#include <vector>

#include "engine/measure/simd_measure.h"
#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/solvers/constraint_solver.h"
#include "engine/solvers/yarn/held_spans.h"
#include "engine/solvers/yarn/single_constraints.h"
#include "engine/solvers/yarn/yarn_layout.h"
#include "engine/spheres/sphere_contacts.h"
#include "kernels/loop.h"
#include "kernels/simd/table.h"

namespace weft {

class YarnSolver final : public ConstraintSolver {
 public:
  /// `measure` finds the true errors, in double.
  YarnSolver(const Model& model, const Settings& settings, const simd::Table& table,
             SimdMeasure& measure);

  /// Moves x until every constraint and listed contact is well within tolerance, or until progress
  /// ends. The result is `failed` if the errors no longer fell and are larger than wanted (with
  /// scheme rattle, and where errors contradict each other: than the tolerance), or if iterations
  /// ran out beyond the tolerance. LoopResult::iterations counts sweeps and iterations of conjugate
  /// gradients, at least one in each Newton step; visits counts every solve of a constraint.
  kernels::LoopResult solve_positions(const PositionTask& task, Team& team) override;
  /// Brings the velocities within half of the tolerance, or as near as it can; with `exact` it
  /// reduces their error to a small share, even if that is within the tolerance. It works in
  /// floats, and therefore never reports convergence, which its caller checks in double.
  kernels::LoopResult correct_velocities(const VelocityTask& task, Team& team) override;
  /// The number of particles of the longest yarn.
  std::size_t longest() const { return layout_.longest; }
  /// The same for each chunk of the measure, of the yarns that have a constraint in it. Empty if
  /// all yarns have the same length.
  std::span<const std::uint32_t> longest_at() const { return layout_.longest_at; }
  std::size_t bytes() const override;

 private:
  struct Products {
    double product = 0;  // of residual and z
    double worst = 0;    // largest strain left, or velocity
  };
  /// The strains that a solve aims at.
  struct Aim {
    double wanted;  // a solve that ends with more has failed
    double goal;    // a solve ends when it reaches this
    double left;    // a linear system must leave less
    double block;   // a block with more is solved again at once
  };
  simd::Yarns yarns();
  Aim aim() const;
  bool may_take_newton(const SphereContacts& contacts) const;
  void begin(const PositionTask& task, Team& team);
  void take_laws(const SpringLaws& laws, bool first_round);
  void keep_multipliers(SpringLaws& laws) const;
  /// Sets base and u to the positions x.
  void split(kernels::VectorsView x, Team& team) { split(x, layout_.cell, team); }
  void split(kernels::VectorsView x, double cell, Team& team);
  void keep_start(kernels::VectorsView start, Team& team);
  void join(kernels::VectorsView x, Team& team);
  void join(kernels::VectorsView x, std::size_t first, std::size_t last);
  /// Solves the blocks of each family until their strain is at most `enough`, then relaxes the
  /// single constraints.
  void sweep(double enough, Team& team, kernels::LoopResult& result);
  kernels::LoopResult sweep_so_often(const PositionTask& task, Team& team);
  std::uint32_t solve_block(const simd::Yarns& yarns, std::size_t i, double enough,
                            simd::YarnScratch* scratch);
  bool loses_energy(kernels::VectorsView v) const;
  void count(int passes, std::int64_t visits, std::int64_t corrections,
             kernels::LoopResult& result) const;

  // The linear system (yarn_system.cpp).
  /// One Newton step, solved to the strain `goal`. Returns whether the residual fell; if not, u is
  /// as before.
  bool newton(double goal, int max_iterations, Team& team, kernels::LoopResult& result);
  /// Solves the linearised system until no error exceeds `goal`, or the share `part` of the errors
  /// that are left when the first family is eliminated. Returns what newton() does.
  bool solve(double goal, double part, int max_iterations, Team& team, kernels::LoopResult& result);
  void make_system();
  void linearise(Team& team);
  void linearise_yarns(Team& team);
  void linearise_velocities(Team& team);
  /// The largest error of the velocities; infinite if one is not finite.
  double read_velocities(Team& team);
  Products precondition(double alpha, double goal, Team& team);
  void clear_push(Team& team);
  Products reduce(double goal, Team& team);
  void push(double beta, Team& team);
  void eliminate(simd::YarnElimination what, Team& team);
  double pull(Team& team);
  void finish(Team& team);

  template <class Work>
  void for_each_family(Team& team, Work&& work);
  template <class Work>
  void for_each_block(std::size_t first, std::size_t last, Team& team, Work&& work);

  const Model& model_;
  const YarnLayout& layout_;
  const Settings settings_;
  const double usual_;  // the strain to reach if no spans are held
  const simd::Table& table_;
  SimdMeasure& measure_;

  double cell_ = 0;                               // the grid of base_
  bool from_start_ = false, velocities_ = false;  // the present system
  bool moved_ = false;                            // rows have no differences of this base yet
  kernels::AlignedVector<simd::YarnBaseSteps> base_step_;  // per row
  kernels::AlignedVector<simd::YarnDirections> start_;     // scheme rattle only
  kernels::AlignedVector<simd::YarnSystemRow> system_;     // from the first Newton step on
  kernels::AlignedVector<simd::YarnSpringRow> springs_;    // per row; with springs only
  kernels::AlignedVector<simd::YarnScratch> scratch_;      // one part for each share of blocks
  kernels::AlignedVector<float> base_, u_, t_;             // in the layout of YarnPlaces
  const std::size_t first_end_;                            // end of the first family's blocks
  std::vector<simd::YarnProducts> products_;               // per block
  std::vector<std::uint32_t> solves_;                      // per block: solves in one sweep
  std::vector<std::uint8_t> stubborn_;                     // per block: kMostBlockSolves did not do
  SingleConstraints singles_;
  HeldSpans spans_;
};

/// Calls work(yarns, number of the block, scratch) for each block; threads take shares of the
/// blocks.
template <class Work>
void YarnSolver::for_each_block(std::size_t first, std::size_t last, Team& team, Work&& work) {
  if (first == last) return;
  const simd::Yarns yarns = this->yarns();
  const std::size_t shares =
      std::min({scratch_.size() / layout_.scratch_rows(), last - first, team.size()});
  team.for_each(shares, [&](std::size_t share) {
    const std::size_t begin = first + (last - first) * share / shares;
    const std::size_t end = first + (last - first) * (share + 1) / shares;
    for (std::size_t i = begin; i < end; ++i) {
      work(yarns, i, scratch_.data() + layout_.scratch_rows() * share);
    }
  });
}

/// Calls work for the blocks of one family after the other.
template <class Work>
void YarnSolver::for_each_family(Team& team, Work&& work) {
  for (std::size_t f = 0; f < layout_.families(); ++f) {
    for_each_block(layout_.family_begin[f], layout_.family_begin[f + 1], team, work);
  }
}

}  // namespace weft
