/// The bending of particles in double.
#include "engine/solvers/small_steps/reference_store.h"

#include <algorithm>

#include "engine/solvers/small_steps/bending_frame.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "kernels/reference/bending.h"

namespace weft {

using kernels::Vector;

void ReferenceStore::begin_bending(const FramePlan& plan) {
  give_ = bending_error_ = 0;
  if (layout_.bending.empty()) return;
  double weight = 0;
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    if (layout_.bending.rows.bends(i))
      weight += model_.mass[i] * dot(acceleration_[i], acceleration_[i]);
  }
  bending_frame_.begin(plan, weight);
  bending_.forget_guess();
  if (bending_frame_.is_factored())
    bending_.prepare_factor(model_.bending_fronts(), bending_frame_.usual().law(),
                            now_.has_past && past_.dt_substep == now_.dt_substep);
  else
    bending_.prepare_diagonal(bending_frame_.usual().law());
}

/// Bends all elements at once. Particles go where the last force of bending takes them, and from
/// there to where they bend to; hinges folded at rest begin at the prediction (simd_bending.cpp).
void ReferenceStore::bend(Team& team) {
  const std::optional<BendingStep> step = bending_frame_.next(now_.formula.give(now_.dt_substep));
  if (!step) return;
  double* const guess = bending_.guess();
  const bool begins_anew = give_ == 0 || !layout_.bending.folds.empty();
  const double scale = begins_anew ? 0 : step->give / give_;
  give_ = step->give;
  for (std::size_t i = 0; i < 4 * model_.slots(); ++i) guess[i] *= scale;
  const auto at = [&](std::size_t i) {
    return Vector{guess[4 * i], guess[4 * i + 1], guess[4 * i + 2]};
  };
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    x_.view().add(i, at(i));
    from_.set(i, before_[i] - (step->count - 1) * at(i));
  }
  pull(*step);
  bending_error_ =
      std::max(bending_error_, bending_.solve(step->law(), bending_frame_.limits(), team));
  for (std::size_t i = 0; i < model_.slots(); ++i) x_.view().add(i, -1 * at(i));
  for (std::size_t i = 0; bending_.steps() > 0 && i < 4 * model_.slots(); ++i)
    guess[i] += bending_.change()[i];
  for (std::size_t i = 0; i < model_.slots(); ++i) x_.view().add(i, step->count * at(i));
}

void ReferenceStore::pull(const BendingStep& step) {
  double* const residual = bending_.residual();
  const double resolved = bending_frame_.resolved_turning(step.give);
  std::fill_n(residual, 4 * model_.slots(), 0.0);
  for (std::uint32_t i = 0; i < model_.bending.size(); ++i) {
    const reference::BendingElement e = element(i);
    const double softness =
        resolved * e.compliance / inverse_mass_of(e, model_.inverse_mass.data());
    const reference::Pulls pulls =
        reference::pulls(e, step.damping, softness, x_.view(), from_.view());
    for (std::size_t k = 0; k < 4; ++k) {
      if (!now_.is_free(e.slots[k])) continue;
      double* const of = residual + 4 * std::size_t{e.slots[k]};
      of[0] += pulls[k].x;
      of[1] += pulls[k].y;
      of[2] += pulls[k].z;
    }
  }
}

double ReferenceStore::bending_energy(double give, Team&) {
  const double resolved = bending_frame_.resolved(give);
  double sum = 0;
  for (std::uint32_t i = 0; i < model_.bending.size(); ++i)
    sum += reference::energy(element(i), resolved, model_.inverse_mass.data(), x_.view());
  return sum;
}

double ReferenceStore::releasable_bending_energy(kernels::VectorsView x, double give, Team& team) {
  if (layout_.bending.empty()) return 0;
  const BendingStep step{1 / bending_frame_.resolved(give), 1, 0};
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    predicted_.set(i, x_[i]);
    x_.set(i, x[i]);
    from_.set(i, x[i]);
  }
  double energy = 0;
  for (std::uint32_t i = 0; i < model_.bending.size(); ++i)
    energy += reference::bent_square(element(i), x_.view()) / (2 * element(i).compliance);
  pull(step);
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    const double* const force = bending_.residual() + 4 * i;
    from_.set(i, {force[0], force[1], force[2]});
    x_.set(i, predicted_[i]);
  }
  bending_.forget_guess();
  bending_.solve(step.law(), bending_frame_.limits_of_energy(), team);
  for (std::size_t i = 0; bending_.steps() > 0 && i < model_.slots(); ++i) {
    const double* const d = bending_.change() + 4 * i;
    energy -= 0.5 * dot(from_[i], {d[0], d[1], d[2]});
  }
  return energy;
}

}  // namespace weft
