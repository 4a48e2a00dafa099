#include "engine/solvers/small_steps/bending_pace.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/solvers/small_steps/bending_factor.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/tuning.h"

namespace weft {
namespace {

double count_that_bend(const BendingRows& rows) {
  double count = 0;
  for (std::size_t slot = 0; slot < rows.slots(); ++slot) count += rows.bends(slot) ? 1 : 0;
  return count;
}

/// 1/s^2, of K_ii / m_i over all that bend.
double mean_stiffness(const BendingRows& rows) {
  double sum = 0;
  for (std::size_t slot = 0; slot < rows.slots(); ++slot) {
    if (rows.bends(slot)) sum += rows.doubles.diagonal[slot] / rows.doubles.mass[slot];
  }
  return sum / std::max(1.0, count_that_bend(rows));
}

/// By anything that takes up what a solution leaves of a balance of forces.
bool has_holds(const Model& model) { return !model.holds.empty() || model.has_attached(); }

}  // namespace

BendingPace::BendingPace(const Model& model, const Settings& settings)
    : model_(model),
      rows_(model.small_steps().bending.rows),
      part_((has_holds(model) ? tuning::kBendingPart : tuning::kFreeBendingPart) *
            std::min(settings.tolerance, tuning::kLoosestBending)),
      particles_(count_that_bend(rows_)),
      mean_(mean_stiffness(rows_)),
      scheme_(settings.scheme),
      is_timed_(settings.motion_tolerance > 0) {}

void BendingPace::begin(const FramePlan& plan, double weight) {
  if (rows_.empty()) return;
  const SubstepFormula formula =
      SubstepFormula::of(scheme_, 1).with_decay(model_.damping.motion, plan.h, plan.h);
  const double give = formula.give(plan.h);
  h_ = plan.h;
  step_ = formula.part * plan.h;
  substeps_ = plan.substeps;
  omega_ = plan.omega;
  done_ = 0;
  const auto is_soft = [&](int n) {
    return n * h_ * (n * h_) * mean_ <= tuning::kBendingGroup && !is_timed_;
  };
  int n = 1;
  while (n < std::min(tuning::kLongestGroup, substeps_) && is_soft(n + 1)) ++n;
  while (substeps_ % n != 0 && n * h_ * (n * h_) * mean_ > tuning::kUnevenGroups) --n;
  groups_ = (substeps_ - 1) / n + 1;
  damping_ = model_.damping.bending;
  usual_ = group_of(n, give);
  is_factored_ = n == 1 && is_to_be_factored();
  weight_ = 0;
  if (is_factored_) return;
  const double most =
      std::max(tuning::kLeastBendingDamping, tuning::kBendingDamping / (give * mean_));
  damping_ = std::min(damping_, most * step_);
  usual_.damping = damping_;
  weight_ = weight / (usual_.law().inertia + usual_.law().stiffness * mean_);
}

BendingGroup BendingPace::group_of(int n, double give) const {
  BendingGroup group{.filter = give, .move = 1, .rate = 1 / step_, .damping = damping_};
  if (n == 1) return group;
  group.filter = tuning::kBendingFilter * n * h_ * (n * h_);
  group.move = n * give / group.filter;
  group.rate = 1 / (2 * tuning::kBendingFilter * n * h_);
  return group;
}

/// Whether a factorisation takes less time than the steps along the diagonal, of cloth that is
/// damped no more than these bear.
bool BendingPace::is_to_be_factored() const {
  const double share = usual_.filter * mean_;
  const double stiffness =
      1 + std::min(damping_ * usual_.rate,
                   std::max(tuning::kLeastBendingDamping, tuning::kBendingDamping / share));
  const double steps = tuning::kBendingStepsPerRoot * std::sqrt(stiffness * share);
  if (steps < tuning::kLeastFactored || particles_ > static_cast<double>(tuning::kMostFactored))
    return false;
  const auto values = static_cast<double>(model_.bending_fronts().fronts.values);
  return tuning::kBendingStepTime * steps * particles_ > tuning::kFactorTime * values;
}

/// The impulse acts from the end of its substep on, which is in the middle of the group.
std::optional<BendingGroup> BendingPace::next(double give) {
  if (rows_.empty()) return {};
  const auto begin_of = [&](std::int64_t group) {
    return static_cast<int>(group * substeps_ / groups_);
  };
  const int k = done_++;
  const std::int64_t group = ((k + 1) * std::int64_t{groups_} - 1) / substeps_;
  const int first = begin_of(group), n = begin_of(group + 1) - first;
  if (k != first + (n - 1) / 2) return {};
  return group_of(n, give);
}

}  // namespace weft
