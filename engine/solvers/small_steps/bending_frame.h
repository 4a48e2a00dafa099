/// When and how the bending of a frame is solved (bending_system.h).
///
/// Where all cloth is soft, one solution stands for a group of n substeps, with the impulse of all
/// of them in its middle. Else n is 1. For groups of unequal lengths n is half of the way from the
/// impulse before to the one after: with their own lengths stiffness would change once a frame, and
/// cloth gains energy from that. In a group the force is that of the law
///
///     M d / f = - K (p + d) - tau / h K (p + n d - s),
///
/// and the particles move by n d. There p is predicted, s is where the substep began (turned, as
/// kernels/reference/bending.h has it), and f is the square of b h, as decay leaves it. With n = 1
/// the law holds at the end of the substep. An impulse every n substeps gains
/// energy where a swing is about as fast: so n is bounded by the stiffest particle
/// (tuning::kBendingGroup).
///
/// So damping is a factor on K. It is smaller than asked for where it would make the matrix of soft
/// cloth a stiff one (tuning::kBendingDamping): swings are damped, and creases of single particles
/// are slow to settle anyway.
#pragma once

#include <weft/weft.h>

#include <cmath>
#include <cstdint>
#include <optional>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/bending_system.h"
#include "engine/solvers/small_steps/frame_to_do.h"
#include "engine/tuning.h"

namespace weft {

/// How a group of substeps is solved.
struct BendingStep {
  double give = 0;     // s^2, f
  double count = 1;    // n
  double damping = 0;  // tau / h
  BendingLaw law() const { return {1 / give, 1 + count * damping}; }
};

class BendingFrame {
 public:
  BendingFrame(const Model& model, const Settings& settings);

  /// weight: of a frame, the sum of m a^2 over all that bend, of what accelerates them from
  /// outside.
  void begin(const FramePlan& plan, double weight);
  /// The step of the next substep, with its give; none where its group is solved in another.
  std::optional<BendingStep> next(double give);
  /// Whether that of the present substep is.
  bool is_solved_now() const { return is_solved_now_; }
  /// The step of a whole group of substeps as most are.
  BendingStep usual() const { return step(give_, longest_); }

  bool is_factored() const { return is_factored_; }
  BendingLimits limits() const { return {part_, weight_, tuning::kMostBendingSteps}; }
  /// The error of an energy is the square of that of the force.
  BendingLimits limits_of_energy() const {
    return {std::sqrt(part_), weight_, tuning::kMostBendingSteps};
  }
  /// 1/s^2. Constraints after bending may load elements that are stiffer than a substep resolves:
  /// these have no more energy than the softest that is not resolved, in substeps with the `give`
  /// of a sweep, (b h)^2 / omega.
  double resolved(double give) const { return 1 / ((1 - 0.5 * omega_) * give); }
  /// 1/s^2. The same of the part of a fold that its normal turns by, which no solution knows.
  double resolved_turning(double give) const { return tuning::kResolvedTurning * resolved(give); }

 private:
  BendingStep step(double give, double n) const { return {give, n, damping_}; }
  /// The substep of this frame, or of others like it before and after.
  int solved_in(std::int64_t group) const;
  int longest_group(const FramePlan& plan) const;
  double most_damping() const;
  bool is_to_be_factored() const;

  const Model& model_;
  const BendingRows& rows_;
  const double part_;
  const double particles_;  // that bend
  const double mean_;       // 1/s^2, of K_ii / m_i
  const Scheme scheme_;
  const bool is_timed_;  // the error of motion is measured
  bool is_factored_ = false, is_solved_now_ = false;
  double weight_ = 0, damping_ = 0, give_ = 1, omega_ = 1;
  int substeps_ = 0, done_ = 0, groups_ = 1, longest_ = 1;
};

}  // namespace weft
