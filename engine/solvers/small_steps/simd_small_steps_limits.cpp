/// Small steps at limits: anchors and bodies hold particles, and a motion ends where one arrives.
#include "engine/solvers/small_steps/lane_points.h"
#include "engine/solvers/small_steps/simd_small_steps.h"

namespace weft {

void SmallStepsSolver::hold_anchors(Team& team) {
  if (anchors_.empty()) return;
  anchors_.hold(flight(), weights_.last.rate, team);
  anchors_.report([&](std::uint32_t slot) { arrived_.push_back({slot}); },
                  [&](std::uint32_t slot) { passes_.look_at(slot); });
}

void SmallStepsSolver::begin_bodies(const FramePlan& plan) {
  const bool goes_on = has_past_ && !plan.bodies_move;
  const auto begin = [&] {
    bodies_.begin(plan.bodies, plan.h, plan.substeps, plan.projects,
                  goes_on ? past_.touching : std::span<const std::uint16_t>{},
                  plan.placed || plan.bodies_are_new, past_.misplaced);
  };
  plan.bodies.empty() ? begin() : contact_times.timed(&ContactMs::find, begin);
}

/// Contacts come last.
void SmallStepsSolver::hold_bodies(Team& team) {
  if (bodies_.empty()) return;
  contact_times.timed(&ContactMs::sweep, [&] {
    bodies_.hold(flight(), base_.data(), weights_.last.rate, team);
    const LanePoints points = this->points(true);
    bodies_.report(
        [&](std::uint32_t slot) {
          arrived_.push_back({slot, bodies_.touched_by(slot, points.place(u_.data(), slot))});
        },
        [&](std::uint32_t slot) { passes_.look_at(slot); },
        [&](std::uint32_t slot) { points.grip(slot); });
  });
  hold_by_meshes(team);
}

void SmallStepsSolver::hold_by_meshes(Team& team) {
  if (!bodies_.has_meshes()) return;
  const LanePoints points = this->points(true);
  LaneParticles particles(points);
  contact_times.timed(&ContactMs::find, [&] { bodies_.find_where_they_stand(particles, team); });
  contact_times.timed(&ContactMs::sweep, [&] {
    bodies_.hold_by_meshes(particles, team, [&](std::uint32_t slot) { passes_.look_at(slot); });
  });
}

void SmallStepsSolver::advance_bodies(double part, Team& team) {
  if (bodies_.empty()) return;
  const LanePoints points = this->points(true);
  LaneParticles particles(points);
  contact_times.timed(&ContactMs::find,
                      [&] { bodies_.advance(flight(), base_.data(), part, particles, team); });
}

bool SmallStepsSolver::end_contacts(Team& team) {
  if (!bodies_.has_meshes()) return false;
  const LanePoints points = this->points(true);
  LaneParticles particles(points);
  return contact_times.timed(&ContactMs::verify,
                             [&] { return bodies_.end_interval(particles, team); });
}

void SmallStepsSolver::report_bodies(BodyReport& report) { bodies_.sum(report); }

double SmallStepsSolver::deepest_in_body(Team& team) {
  if (bodies_.empty()) return 0;
  const LanePoints points = this->points(true);
  LaneParticles particles(points);
  return contact_times.timed(
      &ContactMs::verify, [&] { return bodies_.deepest(flight(), base_.data(), particles, team); });
}

void SmallStepsSolver::read_contacts(std::vector<BodyTouch>& contacts) {
  if (bodies_.empty()) return;
  const LanePoints points = this->points(true);
  bodies_.read_contacts(LaneParticles(points), contacts);
}

/// A contact ends a motion, and so does a limit: from there a particle goes on at first order.
void SmallStepsSolver::end_motions() {
  take_each_once(touched_, [&](std::uint32_t slot) { stop_at_contact(slot); });
  take_arrivals(arrived_, [&](const Arrival& arrival) { begin_at_limit(arrival); });
}

/// The velocity v of a particle that was pushed is the mean one of this substep, and its past is
/// such that the next one begins as by the implicit Euler method: with v + h a, at x + h v + h^2 a.
void SmallStepsSolver::stop_at_contact(std::uint32_t slot) {
  if (model_.inverse_mass[slot] == 0) return;
  const auto h = static_cast<float>(h_), push = static_cast<float>(h_ * decaying_share());
  std::size_t at = layout_.places().of(slot);
  for (int axis = 0; axis < 3; ++axis, at += layout_.places().stride) {
    const float a = acceleration_[at], v = (u_[at] - u_before_[at]) / h;
    predicted_[at] = u_[at];
    v_[at] = v;
    v_before_[at] = v - push * a;
    u_before_[at] = u_[at] - h * (v + push * a);
  }
}

/// The velocity is that at the end of this substep, and the past a free flight that leads to it.
void SmallStepsSolver::begin_at_limit(const Arrival& arrival) {
  const auto h = static_cast<float>(h_), push = static_cast<float>(h_ * decaying_share());
  const LanePoints points = this->points(false);
  const kernels::Vector v_before = points.vector(v_before_.data(), arrival.slot);
  std::size_t at = layout_.places().of(arrival.slot);
  for (int axis = 0; axis < 3; ++axis, at += layout_.places().stride) {
    v_[at] += weights_.last.rate * (u_[at] - predicted_[at]);
    const float a = acceleration_[at], v = v_[at];
    predicted_[at] = u_[at];
    v_before_[at] = v - push * a;
    u_before_[at] = u_[at] - h * v + 0.5f * h * h * a;
  }
  if (!arrival.surface.is_there()) return;
  const double counts = model_.mass[arrival.slot] * next_formula_.share_of_past();
  bodies_.arrive(arrival.surface, points.place(u_.data(), arrival.slot),
                 points.vector(v_.data(), arrival.slot),
                 counts * (v_before - points.vector(v_before_.data(), arrival.slot)));
}

}  // namespace weft
