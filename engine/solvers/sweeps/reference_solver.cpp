#include "engine/solvers/sweeps/reference_solver.h"

#include <algorithm>
#include <limits>

#include "engine/bytes_of.h"
#include "engine/solvers/sweeps/reference_layout.h"

namespace weft {

ReferenceSolver::ReferenceSolver(const Model& model, const Settings& settings)
    : model_(model), layout_(model.reference()), settings_(settings) {
  const ConstraintStore& s = model.constraints;
  if (owns_constraints()) {
    a_ = s.a;
    b_ = s.b;
    target_ = s.rest_length;
    effective_mass_ = s.effective_mass;
  }
  const bool to_tolerance = settings.iterations == 0;
  for (const double rest : s.rest_length) {
    tolerance_.push_back(to_tolerance ? settings.tolerance * rest : 0);
  }
  reserve(0);
  if (settings.measuring.skip && !settings.measuring.anticipate) mask_.resize(model.slots());
  if (settings.measuring.skip) moved_.resize(model.slots());
  if (!settings.measuring.anticipate) return;
  row_product_.resize(layout_.rows.items.size());
  row_ready_.resize(s.plain);
  if (settings.measuring.skip) changed_.resize(layout_.block_first.size() - 1);
  if (!model.hubs.empty()) hub_motion_.resize(model.slots());
}

/// Where they are followed by contacts, or differ from substep to substep.
bool ReferenceSolver::owns_constraints() const {
  return model_.has_spheres() || model_.constraints.has_springs();
}

/// Grows only.
void ReferenceSolver::reserve(std::size_t contacts) {
  const std::size_t size = model_.constraints.size() + contacts;
  if (size <= capacity_) return;
  if (owns_constraints()) {
    a_.resize(size);
    b_.resize(size);
    target_.resize(size);
    effective_mass_.resize(size);
  }
  if (model_.constraints.has_springs()) softness_.resize(size);
  if (settings_.scheme == Scheme::rattle) start_target_.resize(size);
  tolerance_.resize(size, settings_.iterations == 0 ? settings_.contact_tolerance : 0);
  direction_.resize(size);
  impulse_.resize(size);
  if (settings_.velocity_correction) {
    velocity_tolerance_.resize(size);
    zero_.resize(size);
  }
  if (settings_.measuring.anticipate) {
    error_.resize(size);
    pending_.resize(size);
  }
  capacity_ = size;
}

void ReferenceSolver::place_contacts(const SphereContacts& contacts) {
  if (model_.constraints.size() + contacts.count() > capacity_) reserve(2 * contacts.count());
  for (std::size_t k = 0; k < contacts.count(); ++k) {
    const std::size_t c = model_.constraints.size() + k;
    a_[c] = contacts.sphere[k];
    b_[c] = contacts.particle[k];
    target_[c] = contacts.distance[k];
    effective_mass_[c] = 1 / (model_.inverse_mass[a_[c]] + model_.inverse_mass[b_[c]]);
  }
}

/// With a fixed number of iterations nothing is tolerated.
void ReferenceSolver::take_laws(const SpringLaws& laws) {
  for (std::size_t c = 0; c < model_.constraints.size(); ++c) {
    target_[c] = laws.target[c];
    softness_[c] = laws.softness[c];
    effective_mass_[c] = 1 / (1 / model_.constraints.effective_mass[c] + laws.softness[c]);
    if (settings_.iterations == 0) tolerance_[c] = laws.tolerance[c];
  }
}

void ReferenceSolver::keep_multipliers(SpringLaws* laws) const {
  if (laws == nullptr) return;
  std::copy_n(impulse_.data(), laws->multiplier.size(), laws->multiplier.data());
}

reference::Relaxation ReferenceSolver::problem(kernels::VectorsView x, std::size_t contacts) {
  const ConstraintStore& s = model_.constraints;
  const bool own = owns_constraints();
  reference::Relaxation r;
  r.particles = model_.slots();
  r.plain = s.plain;
  r.bilateral = s.bilateral;
  r.pulling = s.size();
  r.count = s.size() + contacts;
  r.a = own ? a_.data() : s.a.data();
  r.b = own ? b_.data() : s.b.data();
  r.target = own ? target_.data() : s.rest_length.data();
  r.tolerance = tolerance_.data();
  r.effective_mass = own ? effective_mass_.data() : s.effective_mass.data();
  r.inverse_mass = model_.inverse_mass.data();
  r.x = x;
  r.n = direction_.view();
  r.impulse = impulse_.data();
  return r;
}

reference::Workspace ReferenceSolver::workspace() {
  reference::Workspace w;
  w.error = error_.data();
  w.pending = pending_.data();
  w.row_product = row_product_.data();
  w.row_ready = row_ready_.data();
  w.hub_motion = hub_motion_.view();
  w.hubs = model_.hubs;
  w.changed = changed_.data();
  w.mask = mask_.data();
  w.moved = moved_.data();
  return w;
}

reference::Method ReferenceSolver::method(const kernels::LoopLimits& limits) const {
  return {.anticipate = settings_.measuring.anticipate,
          .skip = settings_.measuring.skip,
          .frozen_directions = settings_.measuring.directions == Directions::frozen,
          .limits = limits};
}

reference::Relaxation ReferenceSolver::position_problem(kernels::VectorsView x, double h,
                                                        const SphereContacts& contacts,
                                                        const SpringLaws* laws, bool first_round) {
  place_contacts(contacts);
  if (laws != nullptr) take_laws(*laws);
  if (first_round) std::ranges::fill(impulse_, 0.0);
  reference::Relaxation r = problem(x, contacts.count());
  if (laws != nullptr) r.softness = softness_.data();
  if (settings_.measuring.impulse_limit > 0) r.limit = settings_.measuring.impulse_limit * h;
  return r;
}

kernels::LoopResult ReferenceSolver::solve_positions(kernels::VectorsView x,
                                                     kernels::VectorsView start, double h,
                                                     const SphereContacts& contacts,
                                                     SpringLaws* laws, bool first_round,
                                                     const kernels::LoopLimits& limits) {
  reference::Relaxation r = position_problem(x, h, contacts, laws, first_round);
  if (start.x != nullptr) take_directions_at(start, r);
  const reference::ContactLists lists{contacts.first.data(), contacts.next.data()};
  const auto result = reference::relax_positions(
      r, layout_.topology(), model_.has_spheres() ? lists : reference::ContactLists{}, workspace(),
      method(limits));
  keep_multipliers(laws);
  return result;
}

kernels::LoopResult ReferenceSolver::solve_previewed_positions(const reference::Motion& motion,
                                                               double h,
                                                               const SphereContacts& contacts,
                                                               SpringLaws* laws, bool first_round,
                                                               const kernels::LoopLimits& limits) {
  const auto r = position_problem(motion.solved, h, contacts, laws, first_round);
  const auto result = reference::relax_previewed_positions(r, motion, h, method(limits));
  keep_multipliers(laws);
  return result;
}

void ReferenceSolver::take_directions_at(kernels::VectorsView start, reference::Relaxation& r) {
  r.start = start;
  r.rest_length = r.target;
  std::copy(r.target + r.pulling, r.target + r.count, start_target_.data() + r.pulling);
  r.target = r.start_target = start_target_.data();
}

/// Ropes and contacts take part where they are taut or touch; slack ones get an endless tolerance.
void ReferenceSolver::choose_velocity_tolerances(const reference::Relaxation& r,
                                                 kernels::VectorsView x) {
  const double tolerance = settings_.iterations == 0 ? settings_.velocity_tolerance : 0;
  for (std::size_t c = 0; c < r.count; ++c) {
    bool active = true;
    if (c >= r.bilateral) {
      const double e = length(x[r.a[c]] - x[r.b[c]]) - r.target[c];
      active = c < r.pulling ? e >= -r.tolerance[c] : e <= r.tolerance[c];
    }
    velocity_tolerance_[c] = active ? tolerance : std::numeric_limits<double>::infinity();
  }
}

kernels::LoopResult ReferenceSolver::correct_velocities(kernels::VectorsView x,
                                                        kernels::VectorsView v,
                                                        const SphereContacts& contacts,
                                                        const kernels::LoopLimits& limits) {
  place_contacts(contacts);  // positions may have been solved elsewhere
  reference::Relaxation r = problem(x, contacts.count());
  reference::renew_all_directions(r, x);
  choose_velocity_tolerances(r, x);
  std::ranges::fill(impulse_, 0.0);
  r.x = v;
  r.target = zero_.data();
  r.tolerance = velocity_tolerance_.data();
  if (settings_.measuring.impulse_limit > 0) r.limit = settings_.measuring.impulse_limit;
  const reference::ContactLists lists{contacts.first.data(), contacts.next.data()};
  return reference::relax_velocities(r, layout_.topology(),
                                     model_.has_spheres() ? lists : reference::ContactLists{},
                                     workspace(), method(limits));
}

std::size_t ReferenceSolver::bytes() const {
  return bytes_of(a_) + bytes_of(b_) + bytes_of(target_) + bytes_of(effective_mass_) +
         bytes_of(softness_) + bytes_of(start_target_) + bytes_of(tolerance_) +
         bytes_of(velocity_tolerance_) + bytes_of(zero_) + direction_.bytes() + bytes_of(impulse_) +
         bytes_of(error_) + bytes_of(pending_) + bytes_of(row_product_) + bytes_of(row_ready_) +
         bytes_of(changed_) + bytes_of(moved_) + hub_motion_.bytes() + bytes_of(mask_);
}

}  // namespace weft
