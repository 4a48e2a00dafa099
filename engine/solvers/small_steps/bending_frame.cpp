#include "engine/solvers/small_steps/bending_frame.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/solvers/small_steps/bending_factor.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/solvers/small_steps/substep_formula.h"
#include "engine/tuning.h"

namespace weft {

BendingFrame::BendingFrame(const Model& model, const Settings& settings)
    : model_(model),
      rows_(model.small_steps().bending.rows),
      part_(tuning::kBendingPart * std::min(settings.tolerance, tuning::kLoosestBending)),
      particles_(count_that_bend(rows_)),
      mean_(mean_stiffness(rows_)),
      scheme_(settings.scheme),
      is_timed_(settings.motion_tolerance > 0) {}

int BendingFrame::longest_group(const FramePlan& plan) const {
  if (is_timed_) return 1;
  const double most = std::sqrt(tuning::kBendingGroup / rows_.stiffest) / plan.dt_substep;
  const int longest = std::min(tuning::kLongestGroup, plan.substeps);
  return std::max(1, static_cast<int>(std::min<double>(most, longest)));
}

void BendingFrame::begin(const FramePlan& plan, double weight) {
  if (rows_.empty()) return;
  const SubstepFormula formula =
      SubstepFormula::of(scheme_, 1)
          .with_decay(model_.damping.motion, plan.dt_substep, plan.dt_substep);
  give_ = formula.give(plan.dt_substep);
  omega_ = plan.omega;
  substeps_ = plan.substeps;
  done_ = 0;
  longest_ = longest_group(plan);
  groups_ = (substeps_ - 1) / longest_ + 1;
  damping_ = model_.damping.bending / plan.dt_substep;
  weight_ = 0;
  is_factored_ = is_to_be_factored();
  if (is_factored_) return;
  damping_ = std::min(damping_, most_damping());
  const BendingLaw law = usual().law();
  weight_ = weight / (law.inertia + law.stiffness * mean_);
}

/// The impulse acts from the end of its substep on, which is in the middle of the group.
int BendingFrame::solved_in(std::int64_t group) const {
  const auto begin_of = [&](std::int64_t g) { return static_cast<int>(g * substeps_ / groups_); };
  const int first = begin_of(group), n = begin_of(group + 1) - first;
  return first + (n - 1) / 2;
}

std::optional<BendingStep> BendingFrame::next(double give) {
  if (rows_.empty()) return {};
  const int k = done_++;
  const std::int64_t group = ((k + 1) * std::int64_t{groups_} - 1) / substeps_;
  is_solved_now_ = k == solved_in(group);
  if (!is_solved_now_) return {};
  return step(give, 0.5 * (solved_in(groups_ + group + 1) - solved_in(groups_ + group - 1)));
}

/// The most damping of a matrix that is not factored. By single substeps: groups change no damping.
double BendingFrame::most_damping() const {
  return tuning::kBendingDamping * std::max(1.0, 1 / (give_ * mean_));
}

/// Whether a factorisation takes less time than the steps along the diagonal, of cloth that is
/// damped no more than these bear.
bool BendingFrame::is_to_be_factored() const {
  const double stiffness = 1 + longest_ * std::min(damping_, most_damping());
  const double steps = tuning::kBendingStepsPerRoot * std::sqrt(stiffness * give_ * mean_);
  if (steps < tuning::kLeastFactored || particles_ > static_cast<double>(tuning::kMostFactored))
    return false;
  const auto values = static_cast<double>(model_.bending_fronts().fronts.values);
  return tuning::kBendingStepTime * steps * particles_ > tuning::kFactorTime * values;
}

}  // namespace weft
