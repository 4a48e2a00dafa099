/// Forces of a frame of small steps that change within it. The force of the air is that of
/// the start of the frame (air.h) or, with State::air_parts above 1, of the start of each part of
/// the frame. Pressures follow the shape in every substep (pressure.h).
#pragma once

#include <algorithm>

#include "engine/step/air.h"
#include "engine/step/frame_places.h"
#include "engine/step/pressure.h"

namespace weft {

class FrameForces {
 public:
  FrameForces(State& s, const FramePlan& plan, FramePlaces& places)
      : s_(s), plan_(plan), places_(places) {}

  void begin() {
    if (s_.model->has_air() && s_.air_parts > 1)
      looks_every_ = std::max(1, static_cast<int>(plan_.substeps / s_.air_parts));
    presses_ = presses(s_);
    every_ = presses_ ? 1 : looks_every_;
    if (every_ == 0) return;
    s_.air_from = s_.position;
    for (std::size_t slot = 0; slot < s_.model->slots(); ++slot)
      s_.air_impulse.set(slot, {0, 0, 0});
  }
  void begin_substep(Team& team) {
    if (every_ == 0 || places_.done() - begun_ != every_) return;
    places_.read(team);
    end_part();
    s_.air_from = s_.solved;
    if (looks_every_ > 0 && begun_ - looked_ == looks_every_) look(team);
    s_.small_steps->accelerate(s_.gravity, s_.total_force.view());
  }
  /// After the sweep of a substep.
  void end_sweep(Team& team) {
    if (s_.pressed.area.size() == 0) return;
    places_.read(team);
    let_gas_give_way(s_, s_.solved.view());
  }
  /// Where forces changed State::total_force becomes its mean of the frame. Returns J, by which the
  /// work that was done differs from that of the mean.
  double end() {
    if (every_ == 0 || (begun_ == 0 && !presses_)) return 0;
    end_part();
    for (std::size_t slot = 0; slot < s_.model->slots(); ++slot) {
      if (s_.model->inverse_mass[slot] == 0) continue;
      const kernels::Vector mean = (1 / (plan_.dt_substep * plan_.substeps)) * s_.air_impulse[slot];
      work_ -= dot(mean, s_.solved[slot] - s_.position[slot]);
      s_.total_force.set(slot, mean);
    }
    return work_;
  }

 private:
  void look(Team& team) {
    SmallSteps& solver = *s_.small_steps;
    solver.settle(team);
    solver.read_velocities(s_.next_velocity.view(), team);
    const double h = plan_.dt_substep * std::min(looks_every_, places_.left());
    find_velocity_forces(s_, s_.solved.view(), s_.next_velocity.view(), 0, h, team);
    if (presses_) {
      s_.pressed.beside = s_.total_force;
      press(s_, s_.solved.view());
    }
    looked_ = begun_;
  }
  /// Counts work of forces held since the last one began. Pressures are those of here from now on.
  void end_part() {
    const double h = plan_.dt_substep * (places_.done() - begun_);
    const kernels::Vectors& beside = presses_ ? s_.pressed.beside : s_.total_force;
    for (std::size_t slot = 0; slot < s_.model->slots(); ++slot) {
      if (s_.model->inverse_mass[slot] == 0) continue;
      work_ += dot(beside[slot], s_.solved[slot] - s_.air_from[slot]);
      s_.air_impulse.view().add(slot, h * s_.total_force[slot]);
    }
    if (presses_) {
      press(s_, s_.solved.view());
      work_ += work_of_pressure(s_);
    }
    begun_ = places_.done();
  }

  State& s_;
  const FramePlan& plan_;
  FramePlaces& places_;
  int every_ = 0, looks_every_ = 0;  // substeps; 0: forces, the air are those of the beginning
  int begun_ = 0, looked_ = 0;       // of the present part, in substeps
  bool presses_ = false;
  double work_ = 0;  // J
};

}  // namespace weft
