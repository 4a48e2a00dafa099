/// When bending elements are visited. Cloth bends softly: an element swings far slower than what
/// stretches, and one visit may stand for many substeps, with the impulse of all of them.
///
/// A frame is cut into groups of n substeps, the last one perhaps of fewer, and a group's visit is
/// in its middle. Each class of elements (bending_layout.h) has its own n. The one with the largest
/// W / compliance, W = sum of w_i c_i^2, would swing alone with an angular frequency of sqrt(W /
/// compliance) at least. Impulses that are n h apart resolve this if
///
///     (n h)^2 W / compliance
///
/// is far below 1 (tuning::kBendingPace), and they take what its damping of the time tau asks if n
/// h tau W / compliance is not limited (tuning::kMostBendingDamping). Where a single substep is
/// beyond that n is 1.
#pragma once

#include <vector>

#include "engine/solvers/small_steps/bending_layout.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "kernels/reference/bending.h"

namespace weft {

class BendingPace {
 public:
  /// stiffest: 1/s^2, the largest W / compliance. damping: s, tau.
  BendingPace(double stiffest, double damping) : stiffest_(stiffest), damping_(damping) {}

  void begin(const FramePlan& plan);
  /// n of the visit in the next substep; 0: there is none.
  int next();
  /// With positions that move by give w f.
  reference::BendingVisit visit(int n, double give) const;
  /// 1/s^2. A visit in each substep is a spring of the compliance W (1 / omega - 1/2) (b h)^2 at
  /// least: an element has no more energy than that lets it have. Returns W over this compliance,
  /// with give for (b h)^2 / omega.
  double resolved(double give) const { return 1 / ((1 - 0.5 * omega_) * give); }

  /// n of a whole group.
  int group() const { return group_; }

 private:
  double stiffest_, damping_;
  double h_ = 0, omega_ = 1;
  int substeps_ = 0, done_ = 0, group_ = 1;
};

/// One for each class.
std::vector<BendingPace> paces_of(const BendingLayout& layout, double damping);

}  // namespace weft
