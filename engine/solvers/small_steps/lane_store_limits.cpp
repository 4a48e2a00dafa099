/// Limits and ends: anchors and bodies hold particles of a LaneStore, and a motion ends where one
/// arrives.
#include "engine/solvers/small_steps/lane_store.h"

namespace weft {

void LaneStore::hold_anchors(Team& team) {
  if (anchors_.empty()) return;
  anchors_.hold(flight(), weights_.last.rate, team);
  anchors_.report([&](std::uint32_t slot) { now_.arrived.push_back({slot}); },
                  [&](std::uint32_t slot) { now_.passes.look_at(slot); });
}

void LaneStore::hold_bodies(Team& team) {
  bodies_.hold(flight(), base_.data(), weights_.last.rate, team);
  const LanePoints points = this->points(true);
  bodies_.report(
      [&](std::uint32_t slot) {
        now_.arrived.push_back({slot, bodies_.touched_by(slot, points.place(u_.data(), slot))});
      },
      [&](std::uint32_t slot) { now_.passes.look_at(slot); },
      [&](std::uint32_t slot) { points.solve_contacts(slot); });
}

void LaneStore::hold_by_meshes(Team& team) {
  const LanePoints points = this->points(true);
  TakenParticles particles(points, at_hand_);
  bodies_.hold_by_meshes(particles, team, [&](std::uint32_t slot) { now_.passes.look_at(slot); });
}

void LaneStore::begin_bodies(const FramePlan& plan) {
  bodies_.begin(
      plan.bodies, plan.dt_substep, plan.substeps, plan.projects(),
      now_.has_past && !plan.bodies_move ? past_.touching : std::span<const std::uint16_t>{},
      plan.contact_start(), past_.misplaced, now_.has_past ? &past_.contacts : nullptr);
  if (bodies_.has_meshes()) at_hand_.make_room(model_.slots());
}

void LaneStore::advance_bodies(double part, Team& team) {
  const LanePoints points = this->points(true);
  LaneParticles particles(points);
  bodies_.advance(flight(), base_.data(), part, particles, team);
}

double LaneStore::deepest_in_body(Team& team) {
  const LanePoints points = this->points(true);
  LaneParticles particles(points);
  return bodies_.deepest(flight(), base_.data(), particles, team);
}

/// The velocity v of a particle that was pushed is the mean one of this substep, and its past is
/// such that the next one begins as by the implicit Euler method: with v + h a, at x + h v + h^2 a.
void LaneStore::stop_at_contact(std::uint32_t slot) {
  const auto h = static_cast<float>(now_.dt_substep),
             push = static_cast<float>(now_.dt_substep * now_.decaying_share());
  std::size_t at = layout_.places().of(slot);
  for (int axis = 0; axis < 3; ++axis, at += layout_.places().stride) {
    const float a = acceleration_[at], v = (u_[at] - u_before_[at]) / h;
    predicted_[at] = u_[at];
    v_[at] = v;
    v_before_[at] = v - push * a;
    u_before_[at] = u_[at] - h * (v + push * a);
  }
}

void LaneStore::begin_at_limit(std::uint32_t slot) {
  const auto h = static_cast<float>(now_.dt_substep),
             push = static_cast<float>(now_.dt_substep * now_.decaying_share());
  std::size_t at = layout_.places().of(slot);
  for (int axis = 0; axis < 3; ++axis, at += layout_.places().stride) {
    v_[at] += weights_.last.rate * (u_[at] - predicted_[at]);
    const float a = acceleration_[at], v = v_[at];
    predicted_[at] = u_[at];
    v_before_[at] = v - push * a;
    u_before_[at] = u_[at] - h * v + 0.5f * h * h * a;
  }
}

void LaneStore::jump_velocity(std::uint32_t slot, kernels::Vector by) {
  const auto h = static_cast<float>(now_.dt_substep);
  std::size_t at = layout_.places().of(slot);
  for (const double faster : {by.x, by.y, by.z}) {
    v_[at] += weights_.last.rate * (u_[at] - predicted_[at]);
    predicted_[at] = u_[at];
    v_before_[at] += static_cast<float>(faster);
    u_before_[at] = u_[at] - h * v_[at];
    at += layout_.places().stride;
  }
}

}  // namespace weft
