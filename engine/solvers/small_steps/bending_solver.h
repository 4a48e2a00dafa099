/// When and how the bending of a frame is solved (bending_system.h).
///
/// Cloth bends softly: it swings far slower than what stretches, and one solution may stand for n
/// substeps, with the impulse of all of them. A frame is cut into groups of n, the last one perhaps
/// of fewer, and the solution is in the middle of a group. Impulses that are n h apart resolve the
/// swings of every particle where (n b h)^2 K_ii is far below its mass (tuning::kBendingGroup). What
/// they do not resolve would fly on with the velocity of an impulse until the next one, and gain
/// energy. So n is 1 where a particle, as at a sliver, is stiffer than that.
///
/// In a substep whose positions move by g w f, with the damping of the time tau,
///
///     M x / (n g) = - K (p + x) - tau K (v + x / (b h)),
///
/// where p and v are predicted. So damping is a factor on K. It is smaller than asked for where it
/// would make the matrix of soft cloth a stiff one (tuning::kBendingDamping): swings are damped,
/// and creases of single particles are slow to settle anyway.
#pragma once

#include <weft/weft.h>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/bending_system.h"
#include "engine/solvers/small_steps/small_steps.h"

namespace weft {

class BendingSolver {
 public:
  BendingSolver(const Model& model, const Settings& settings, const simd::Table& table);

  bool empty() const { return rows_.empty(); }
  /// weight: of a frame, the sum of m a^2 over all particles, of what accelerates them from
  /// outside.
  void begin(const FramePlan& plan, double weight);
  /// n of the solution in the next substep; 0: there is none.
  int next();
  /// s, tau of the pulls.
  double damping() const { return damping_; }
  /// 1/s^2. What constraints do after bending may load elements that are stiffer than a substep
  /// resolves: these have no more energy than the softest that is not resolved has, of substeps
  /// that a sweep gives by `give` in, (b h)^2 / omega.
  double resolved(double give) const { return 1 / ((1 - 0.5 * omega_) * give); }
  /// Where the pulls of all elements go, four numbers for each slot.
  double* residual() { return system_.residual(); }
  bool is_free(std::size_t slot) const { return rows_.mass[slot] > 0; }
  /// give: (b h)^2 of the substep.
  void solve(int n, double give, Team& team);
  /// m, four numbers for each slot.
  const double* solution() const { return system_.solution(); }

  /// The largest share of a force of bending that a solution of the frame has left.
  double error() const { return error_; }
  std::size_t bytes() const { return system_.bytes(); }

 private:
  bool is_to_be_factored(double inertia, double stiffness) const;

  const Model& model_;
  const BendingRows& rows_;
  BendingSystem system_;
  const double part_;  // of a residual, that may be left
  const double mean_, most_;  // 1/s^2, of K_ii / m_i
  const Scheme scheme_;
  double damping_ = 0, error_ = 0;
  double unseen_ = 0;  // r . r / diagonal that is left
  double omega_ = 1;
  int substeps_ = 0, done_ = 0, group_ = 1;
};

}  // namespace weft
