/// The yarn solver: whole chains of constraints at a time.
///
/// A sweep solves the yarns of each family, one family after the other, until their own errors are
/// small: Newton's method on kLanes yarns at a time, directions and errors taken anew, between
/// families block Gauss-Seidel (kernels/simd/yarns.h). After it come the constraints that no yarn
/// holds (ropes, hubs, contacts), one by one, their accumulated impulses clamped. Every
/// block minimises the same convex quadratic of the impulses, 1/2 l'Al - e'l, over its own ones
/// with the others held, so that along fixed directions a pass never raises it: this is why the
/// coupling converges.
///
/// Where sweeps gain too little, Newton's method takes over: all yarns as one linear system, the
/// first family eliminated, the others solved by conjugate gradients with their yarns as
/// preconditioner (kernels/simd/yarn_system.h).
///
/// Velocities are linear: one system, solved in the same way.
///
/// Errors are judged in double after each sweep, while they are far off after every second; a
/// Newton step has a sweep behind it. If they do not fall the solver gives up early, for its caller
/// to answer.
#pragma once

#include <weft/weft.h>

#include <algorithm>
#include <vector>

#include "engine/contacts/contacts.h"
#include "engine/measure/simd_measure.h"
#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/solvers/constraint_solver.h"
#include "engine/solvers/yarn/held_spans.h"
#include "engine/solvers/yarn/single_constraints.h"
#include "kernels/loop.h"
#include "kernels/simd/table.h"

namespace weft {

class YarnSolver final : public ConstraintSolver {
 public:
  /// What is aimed at where the tolerance is larger: what is left is noise that the next steps
  /// would have to fight (corners, 81 x 81, 1 %: as many iterations a frame at a quarter of the
  /// error).
  static constexpr double kGoal = 0.003;

  /// measure: of the true errors.
  YarnSolver(const Model& model, const Settings& settings, const simd::Table& table,
             SimdMeasure& measure);

  /// Moves x until every constraint and listed contact is well within tolerance, or as far as it
  /// gets: failed where it no longer came nearer and is short of what it wanted (scheme rattle, and
  /// where errors contradict each other: of the tolerance), or where iterations ran out beyond the
  /// tolerance. LoopResult::iterations counts sweeps and iterations of conjugate gradients, at
  /// least one in each Newton step; visits, every solve of a constraint.
  kernels::LoopResult solve_positions(const PositionTask& task, Team& team) override;
  /// Brings the velocities within half of the tolerance, or as far as it gets; with `exact` to a
  /// small part of what they were out by, however little that is. It works in floats, and so leaves
  /// it to others to say that velocities have converged.
  kernels::LoopResult correct_velocities(const VelocityTask& task, Team& team) override;
  std::size_t longest() const { return layout_.longest; }  // particles of the longest yarn
  /// Per chunk of the measure: of the yarns that have a constraint there. Empty: all are as long.
  std::span<const std::uint32_t> longest_at() const { return layout_.longest_at; }
  std::size_t bytes() const override;

 private:
  struct Products {
    double product = 0;  // residual . z
    double worst = 0;    // largest strain left, or velocity
  };
  /// Of a solve, as strains.
  struct Aim {
    double wanted;  // with more the solver has failed
    double goal;    // with this it is done
    double left;    // a linear system leaves less
    double block;   // a block with less is not solved again at once
  };
  simd::Yarns yarns();
  Aim aim(double share) const;
  bool may_take_newton(const ContactStore& contacts) const;
  void begin(const PositionTask& task, Team& team);
  /// Starts at the positions x.
  void split(kernels::VectorsView x, Team& team) { split(x, layout_.cell, team); }
  void split(kernels::VectorsView x, double cell, Team& team);
  void keep_start(kernels::VectorsView start, Team& team);
  void join(kernels::VectorsView x, Team& team);
  void join(kernels::VectorsView x, std::size_t first, std::size_t last);
  /// Each family, its blocks until their lengths are within the share `enough`, then the others.
  void sweep(double enough, Team& team, kernels::LoopResult& result);
  kernels::LoopResult sweep_so_often(kernels::VectorsView x, int times, Team& team);
  std::uint32_t solve_block(const simd::Yarns& yarns, std::size_t i, double enough,
                            simd::YarnScratch* scratch);
  bool loses_energy(kernels::VectorsView v) const;
  void count(int passes, std::int64_t visits, std::int64_t corrections,
             kernels::LoopResult& result) const;

  // The linear system: yarn_system.cpp.
  /// One of them, to the strain `goal`. Returns whether it came nearer; if not, nothing was moved.
  bool newton(double goal, int max_iterations, Team& team, kernels::LoopResult& result);
  /// What was linearised, until no error is above `goal`, or the share `part` of what is left
  /// when the first family is eliminated. Returns as newton.
  bool solve(double goal, double part, int max_iterations, Team& team, kernels::LoopResult& result);
  void make_system();
  void linearise(Team& team);
  void linearise_yarns(Team& team);
  void linearise_velocities(Team& team);
  double read_velocities(Team& team);  // the largest; infinite if one is not a number
  Products precondition(double alpha, double goal, Team& team);
  void clear_push(Team& team);
  Products reduce(double goal, Team& team);
  void push(double beta, Team& team);
  void eliminate(bool errors, Team& team);
  double pull(Team& team);
  void finish(Team& team);

  template <class Work>
  void for_each_family(Team& team, Work&& work);
  template <class Work>
  void for_each_block(std::size_t first, std::size_t last, Team& team, Work&& work);

  const Model& model_;
  const YarnLayout& layout_;
  const Settings settings_;
  const double usual_;  // strain that is aimed at
  const simd::Table& table_;
  SimdMeasure& measure_;

  double cell_ = 0;                               // that base was split by
  bool from_start_ = false, velocities_ = false;  // what is being solved
  bool moved_ = false;                            // the rows do not remember the present base
  kernels::AlignedVector<simd::YarnBaseSteps> base_step_;  // per row
  kernels::AlignedVector<simd::YarnDirections> start_;     // scheme rattle only
  kernels::AlignedVector<simd::YarnSystemRow> system_;     // from the first Newton step on
  kernels::AlignedVector<simd::YarnScratch> scratch_;      // for each thread
  kernels::AlignedVector<float> base_, u_, t_;             // as YarnPlaces has it
  const std::size_t first_end_;                            // blocks of the first family
  std::vector<simd::YarnProducts> products_;               // per block
  std::vector<std::uint32_t> solves_;                      // per block, in one sweep
  std::vector<std::uint8_t> stubborn_;                     // per block: kMostSolves were too few
  SingleConstraints singles_;
  HeldSpans spans_;
};

/// work(yarns, block's number, scratch); shares of blocks side by side.
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

/// One family after the other.
template <class Work>
void YarnSolver::for_each_family(Team& team, Work&& work) {
  for (std::size_t f = 0; f < layout_.families(); ++f) {
    for_each_block(layout_.family_begin[f], layout_.family_begin[f + 1], team, work);
  }
}

}  // namespace weft
