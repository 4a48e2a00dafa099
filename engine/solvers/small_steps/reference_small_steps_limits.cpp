/// As simd_small_steps_limits.cpp, in double.
#include "engine/solvers/small_steps/reference_points.h"
#include "engine/tuning.h"

namespace weft {

using kernels::Vector;

bool ReferenceSmallSteps::Points::grip(std::uint32_t slot) const {
  const bool is_held = grip_by_bodies(slot);
  if (!bodies->has_meshes()) return is_held;
  Particles particles(*this);
  return bodies->meshes().hold(particles, bodies->clock(), slot) || is_held;
}

void ReferenceSmallSteps::hold_anchors() {
  const Points points = this->points(true);
  const double strain = tuning::kLocalShare * settings_.tolerance;
  for (std::uint32_t i = 0; i < at_limit_.size(); ++i) {
    const std::uint32_t slot = model_.anchors.slot[i];
    const Vector from = x_[slot];
    if (!points.hold(slot, i)) continue;
    if (!at_limit_before_[i] && !at_limit_[i]) arrived_.push_back({slot});
    at_limit_[i] = true;
    if (length(x_[slot] - from) > strain * layout_.anchors.shortest[i]) passes_.look_at(slot);
  }
}

/// Contacts come last.
void ReferenceSmallSteps::hold_bodies(Team& team) {
  if (bodies_.empty()) return;
  const Points points = this->points(true);
  const double strain = tuning::kLocalShare * settings_.tolerance;
  contact_times.timed(&ContactMs::sweep, [&] {
    for (std::uint32_t slot = 0; slot < model_.slots(); ++slot) {
      if (!is_free(slot)) continue;
      const Vector from = x_[slot];
      if (points.grip_by_bodies(slot) && length(x_[slot] - from) > strain * shortest_[slot])
        passes_.look_at(slot);
    }
  });
  hold_by_meshes(team);
}

void ReferenceSmallSteps::hold_by_meshes(Team& team) {
  if (!bodies_.has_meshes()) return;
  const Points points = this->points(true);
  Particles particles(points);
  const double strain = tuning::kLocalShare * settings_.tolerance;
  contact_times.timed(&ContactMs::find, [&] { bodies_.find_where_they_stand(particles, team); });
  contact_times.timed(&ContactMs::sweep, [&] {
    bodies_.hold_by_meshes(particles, team, [&](std::uint32_t slot, double by) {
      if (by > strain * shortest_[slot]) passes_.look_at(slot);
    });
  });
}

void ReferenceSmallSteps::begin_bodies(const FramePlan& plan) {
  const bool goes_on = has_past_ && !plan.bodies_move;
  const auto begin = [&] {
    bodies_.begin(plan.bodies, plan.h, plan.substeps, plan.projects,
                  goes_on ? past_.touching : ReferenceBodies::Touching{},
                  plan.placed || plan.bodies_are_new, past_.misplaced);
  };
  plan.bodies.empty() ? begin() : contact_times.timed(&ContactMs::find, begin);
}

void ReferenceSmallSteps::advance_bodies(double part, Team& team) {
  if (bodies_.empty()) return;
  const Points points = this->points(true);
  Particles particles(points);
  contact_times.timed(&ContactMs::find, [&] { bodies_.advance(part, particles, team); });
}

bool ReferenceSmallSteps::end_contacts(Team& team) {
  if (!bodies_.has_meshes()) return false;
  const Points points = this->points(true);
  Particles particles(points);
  return contact_times.timed(&ContactMs::verify,
                             [&] { return bodies_.end_interval(particles, team); });
}

double ReferenceSmallSteps::deepest_in_body(Team& team) {
  if (bodies_.empty()) return 0;
  const Points points = this->points(true);
  Particles particles(points);
  return contact_times.timed(&ContactMs::verify,
                             [&] { return bodies_.deepest(before_, x_, particles, team); });
}

void ReferenceSmallSteps::read_contacts(std::vector<BodyTouch>& contacts) {
  if (bodies_.empty()) return;
  const Points points = this->points(true);
  bodies_.read_contacts(Particles(points), contacts);
}

void ReferenceSmallSteps::end_motions() {
  take_each_once(touched_, [&](std::uint32_t slot) {
    if (is_free(slot)) stop_at_contact(slot);
  });
  take_arrivals(arrived_, [&](const Arrival& arrival) { begin_at_limit(arrival); });
}

void ReferenceSmallSteps::stop_at_contact(std::size_t i) {
  const Vector v = (1 / h_) * (x_[i] - before_[i]), gain = h_ * decaying_share() * acceleration_[i];
  predicted_.set(i, x_[i]);
  v_.set(i, v);
  v_before_.set(i, v - gain);
  before_.set(i, x_[i] - h_ * (v + gain));
}

void ReferenceSmallSteps::begin_at_limit(const Arrival& arrival) {
  const std::uint32_t i = arrival.slot;
  const double rate = last_ > 0 ? 1 / last_ : 0;  // settled already: what is predicted is there
  const Vector a = acceleration_[i], v = v_[i] + rate * (x_[i] - predicted_[i]);
  const Vector v_before = v - h_ * decaying_share() * a;
  if (arrival.surface.is_there()) {
    const double counts = model_.mass[i] * next_formula_.share_of_past();
    bodies_.arrive(arrival.surface, x_[i], v, counts * (v_before_[i] - v_before));
  }
  predicted_.set(i, x_[i]);
  v_.set(i, v);
  v_before_.set(i, v_before);
  before_.set(i, x_[i] - h_ * v + (0.5 * h_ * h_) * a);
}

}  // namespace weft
