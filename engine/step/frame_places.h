/// The places of particles in a frame of small steps, and the part of it that is done.
#pragma once

#include <span>

#include "engine/solvers/small_steps/small_steps.h"
#include "engine/step/state.h"

namespace weft {

class FramePlaces {
 public:
  FramePlaces(State& s, const FramePlan& plan) : s_(s), plan_(plan) {}

  void end_substep() { ++done_; }
  int done() const { return done_; }
  int left() const { return plan_.substeps - done_; }

  /// Into State::solved.
  void read(Team& team) {
    s_.solved = s_.position;
    s_.small_steps->read_positions(s_.solved.view(), team);
    place_led();
  }
  void read(std::span<const std::uint32_t> slots) {
    s_.small_steps->read_positions_of(slots, s_.solved.view());
    place_led();
  }

 private:
  void place_led() {
    place_pins();
    place_attached();
  }
  /// Exactly where they travel to: lanes round their way.
  void place_pins() {
    if (!s_.pins.moving()) return;
    const double time = plan_.dt_substep * done_;
    for (const std::uint32_t pin : s_.model->pins)
      s_.solved.set(pin, s_.position[pin] + time * s_.velocity[pin]);
  }
  /// Where the points of their anchors are.
  void place_attached() {
    const AnchorStore& anchors = s_.model->anchors;
    const double share = static_cast<double>(done_) / plan_.substeps;
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      if (anchors.limits[i].most > 0) continue;
      const kernels::Vector from = plan_.anchors.from[i].point, to = plan_.anchors.to[i].point;
      s_.solved.set(anchors.slot[i], left() == 0 ? to : from + share * (to - from));
    }
  }

  State& s_;
  const FramePlan& plan_;
  int done_ = 0;  // substeps
};

}  // namespace weft
