/// How the bending of a frame is solved (bending_system.h). In each substep the law
///
///     M d / f = - K (p + d) - tau K (v + d / (b h))
///
/// holds at its end. There p and v are predicted, d is how far bending moves the particles, and f
/// is the square of b h, as decay leaves it.
///
/// So damping is a factor on K. It is smaller than asked for where it would make the matrix of soft
/// cloth a stiff one (tuning::kBendingDamping): swings are damped, and creases of single particles
/// are slow to settle anyway.
#pragma once

#include <weft/weft.h>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/bending_system.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/tuning.h"

namespace weft {

/// How a substep is solved.
struct BendingStep {
  double give = 0;     // s^2, f
  double rate = 0;     // 1/s, of d in damping
  double damping = 0;  // s, tau
  BendingLaw law() const { return {1 / give, 1 + damping * rate}; }
};

class BendingFrame {
 public:
  BendingFrame(const Model& model, const Settings& settings);

  /// weight: of a frame, the sum of m a^2 over all that bend, of what accelerates them from
  /// outside.
  void begin(const FramePlan& plan, double weight);
  /// Of a substep with this give, or with that of most.
  BendingStep step(double give) const { return {give, rate_, damping_}; }
  BendingStep usual() const { return step(give_); }

  bool is_factored() const { return is_factored_; }
  BendingLimits limits() const { return {part_, weight_, tuning::kMostBendingSteps}; }
  /// 1/s^2. What constraints do after bending may load elements that are stiffer than a substep
  /// resolves: these have no more energy than the softest that is not resolved has, of substeps
  /// that a sweep gives by `give` in, (b h)^2 / omega.
  double resolved(double give) const { return 1 / ((1 - 0.5 * omega_) * give); }

 private:
  double most_damping() const;
  bool is_to_be_factored() const;

  const Model& model_;
  const BendingRows& rows_;
  const double part_;
  const double particles_;  // that bend
  const double mean_;       // 1/s^2, of K_ii / m_i
  const Scheme scheme_;
  bool is_factored_ = false;
  double weight_ = 0, damping_ = 0, rate_ = 0, give_ = 1, omega_ = 1;
};

}  // namespace weft
