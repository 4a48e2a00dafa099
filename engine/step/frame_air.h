/// The air of a frame of small steps. It acts for the frame as it was when this began (air.h), or,
/// with State::air_parts above 1, is looked at anew where each part of the frame begins.
#pragma once

#include <algorithm>

#include "engine/step/air.h"
#include "engine/step/frame_places.h"

namespace weft {

class FrameAir {
 public:
  FrameAir(State& s, const FramePlan& plan, FramePlaces& places)
      : s_(s), plan_(plan), places_(places) {}

  void begin() {
    if (!s_.model->has_air() || s_.air_parts <= 1) return;
    every_ = std::max(1, static_cast<int>(plan_.substeps / s_.air_parts));
    s_.air_from = s_.position;
    for (std::size_t slot = 0; slot < s_.model->slots(); ++slot)
      s_.air_impulse.set(slot, {0, 0, 0});
  }
  void begin_substep(Team& team) {
    if (every_ == 0 || places_.done() - begun_ != every_) return;
    places_.read(team);
    end_part();
    s_.air_from = s_.solved;
    SmallSteps& solver = *s_.small_steps;
    solver.settle(team);
    solver.read_velocities(s_.next_velocity.view(), team);
    const double h = plan_.h * std::min(every_, places_.left());
    find_resistance(s_, s_.solved.view(), s_.next_velocity.view(), 0, h, team);
    solver.accelerate(s_.gravity, s_.total_force.view());
  }
  /// Where the air was looked at more than once State::total_force becomes its mean of the frame.
  /// Returns J, by which the work that was done differs from that of the mean.
  double end() {
    if (begun_ == 0) return 0;
    end_part();
    for (std::size_t slot = 0; slot < s_.model->slots(); ++slot) {
      if (s_.model->inverse_mass[slot] == 0) continue;
      const kernels::Vector mean = (1 / (plan_.h * plan_.substeps)) * s_.air_impulse[slot];
      work_ -= dot(mean, s_.solved[slot] - s_.position[slot]);
      s_.total_force.set(slot, mean);
    }
    return work_;
  }

 private:
  /// Of forces that were held since the air was looked at.
  void end_part() {
    const double h = plan_.h * (places_.done() - begun_);
    for (std::size_t slot = 0; slot < s_.model->slots(); ++slot) {
      if (s_.model->inverse_mass[slot] == 0) continue;
      const kernels::Vector force = s_.total_force[slot];
      work_ += dot(force, s_.solved[slot] - s_.air_from[slot]);
      s_.air_impulse.view().add(slot, h * force);
    }
    begun_ = places_.done();
  }

  State& s_;
  const FramePlan& plan_;
  FramePlaces& places_;
  int every_ = 0;    // substeps; 0: the air was looked at when the frame began
  int begun_ = 0;    // of the present part, in substeps
  double work_ = 0;  // J
};

}  // namespace weft
