#include "engine/solvers/small_steps/bending_solver.h"

#include <algorithm>
#include <cmath>

#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/tuning.h"

namespace weft {
namespace {

/// 1/s^2, of K_ii / m_i over all free particles.
double mean_stiffness(const BendingRows& rows) {
  double sum = 0, count = 0;
  for (std::size_t slot = 0; slot < rows.slots(); ++slot) {
    if (rows.mass[slot] == 0) continue;
    sum += rows.diagonal[slot] / rows.mass[slot];
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

/// 1/s^2, the largest K_ii / m_i.
double most_stiffness(const BendingRows& rows) {
  double most = 0;
  for (std::size_t slot = 0; slot < rows.slots(); ++slot) {
    if (rows.mass[slot] > 0) most = std::max(most, rows.diagonal[slot] / rows.mass[slot]);
  }
  return most;
}

/// By anything that takes up what a solution leaves of a balance of forces.
bool is_held(const Model& model) { return !model.pins.empty() || model.has_attached(); }

}  // namespace

BendingSolver::BendingSolver(const Model& model, const Settings& settings, const simd::Table& table)
    : model_(model),
      rows_(model.small_steps().bending.rows),
      system_(rows_, table),
      part_((is_held(model) ? tuning::kBendingPart : tuning::kFreeBendingPart) *
            std::min(settings.tolerance, tuning::kLoosestBending)),
      mean_(mean_stiffness(rows_)),
      most_(most_stiffness(rows_)),
      scheme_(settings.scheme) {}

void BendingSolver::begin(const FramePlan& plan, double weight) {
  if (empty()) return;
  const SubstepFormula formula =
      SubstepFormula::of(scheme_, 1).with_decay(model_.damping.motion, plan.h, plan.h);
  const double give = formula.give(plan.h), bh = formula.part * plan.h;
  substeps_ = plan.substeps;
  omega_ = plan.omega;
  done_ = 0;
  error_ = 0;
  const double share = mean_ * give;
  const auto is_soft = [&](int n) { return n * n * most_ * give <= tuning::kBendingGroup; };
  for (group_ = 1; group_ < tuning::kLongestGroup && is_soft(group_ + 1);) ++group_;
  const double asked = model_.damping.bending / bh;
  const double most = std::max(1.0, tuning::kBendingDamping / (group_ * share));
  const double inertia = 1 / (group_ * give), stiffness = 1 + std::min(asked, most);
  unseen_ = 0;
  if (is_to_be_factored(inertia, stiffness)) {
    damping_ = model_.damping.bending;
    return system_.prepare_factor(model_.bending_fronts(), inertia, 1 + asked);
  }
  damping_ = (stiffness - 1) * bh;
  const double part = tuning::kBendingUnseen * part_;
  unseen_ = part * part * weight / (inertia + stiffness * mean_);
  system_.prepare_diagonal(inertia, stiffness);
}

/// Whether a factorisation takes less time than the steps along the diagonal.
bool BendingSolver::is_to_be_factored(double inertia, double stiffness) const {
  const double steps = tuning::kBendingStepsPerRoot * std::sqrt(stiffness * mean_ / inertia);
  if (steps < tuning::kLeastFactored || model_.particles > tuning::kMostFactored) return false;
  const auto rows = static_cast<double>(rows_.slots());
  const auto values = static_cast<double>(model_.bending_fronts().fronts.values);
  return tuning::kBendingStepTime * steps * rows > tuning::kFactorTime * values;
}

int BendingSolver::next() {
  if (empty()) return 0;
  const int first = done_ - done_ % group_;
  const int size = std::min(group_, substeps_ - first);
  return done_++ == first + size / 2 ? size : 0;
}

/// What is nothing beside the weight is left, which along the diagonal has about this norm.
void BendingSolver::solve(int n, double give, Team& team) {
  const double inertia = 1 / (n * give);
  error_ =
      std::max(error_, system_.solve(inertia, part_, unseen_, tuning::kMostBendingSteps, team));
}

}  // namespace weft
