/// When and how the bending of a frame is solved (bending_system.h).
///
/// Cloth bends softly: it swings far slower than what stretches, and one solution may stand for n
/// substeps, with the impulse of all of them. A frame is cut into groups of n substeps, all of
/// one length, and the impulse is in the middle of a group. There the force is that of a shape q,
///
///     M (q - p) / f = - K q - tau K (v + (q - p) rate),
///
/// where p and v are predicted, and the particles move by (q - p) n g / f, in a substep whose
/// positions move by g w f. In a group of one f is g: the law holds at the end of the substep. In
/// longer ones it is a little more than (n h)^2 / 4, that of the implicit midpoint rule, with which
/// impulses at any distance gain no energy (tuning::kBendingFilter). What swings within a group is
/// slower than it should be, and what rests does not see it: q is where it rests.
///
/// So damping is a factor on K. It is smaller than asked for where it would make the matrix of soft
/// cloth a stiff one (tuning::kBendingDamping): swings are damped, and creases of single particles
/// are slow to settle anyway.
#pragma once

#include <weft/weft.h>

#include <optional>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/bending_system.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/tuning.h"

namespace weft {

/// How a group of substeps is solved.
struct BendingGroup {
  double filter = 0;   // s^2, f
  double move = 1;     // n g / f
  double rate = 0;     // 1/s, of q - p in damping
  double damping = 0;  // s, tau
  BendingLaw law() const { return {1 / filter, 1 + damping * rate}; }
};

class BendingPace {
 public:
  BendingPace(const Model& model, const Settings& settings);

  /// weight: of a frame, the sum of m a^2 over all that bend, of what accelerates them from
  /// outside.
  void begin(const FramePlan& plan, double weight);
  /// Of the next substep, with its give; nothing where its group is solved in another.
  std::optional<BendingGroup> next(double give);

  bool is_factored() const { return is_factored_; }
  /// Of a whole group of the frame.
  const BendingGroup& usual() const { return usual_; }
  BendingLimits limits() const { return {part_, weight_, tuning::kMostBendingSteps}; }
  /// 1/s^2. What constraints do after bending may load elements that are stiffer than a substep
  /// resolves: these have no more energy than the softest that is not resolved has, of substeps
  /// that a sweep gives by `give` in, (b h)^2 / omega.
  double resolved(double give) const { return 1 / ((1 - 0.5 * omega_) * give); }

 private:
  BendingGroup group_of(int n, double give) const;
  bool is_to_be_factored() const;

  const Model& model_;
  const BendingRows& rows_;
  const double part_;
  const double particles_;  // that bend
  const double mean_;       // 1/s^2, of K_ii / m_i
  const Scheme scheme_;
  const bool is_timed_;  // the error of motion is measured
  BendingGroup usual_;
  bool is_factored_ = false;
  double weight_ = 0, damping_ = 0;
  double h_ = 0, step_ = 0, omega_ = 1;  // step: b h
  int substeps_ = 0, done_ = 0, groups_ = 1;
};

}  // namespace weft
