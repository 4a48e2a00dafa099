/// Fixed particles that the caller moves (Cloth::move_fixed).
///
/// A pin travels in a straight line through the whole of the next step: it has a velocity while
/// that lasts, the prediction moves it, and the velocity loop takes it along. Only a move that no
/// motion explains is a jump: one that takes more acceleration, from the pin's last move to this
/// one, than kMostAcceleration. Such a pin is put down before the step, and the cloth follows
/// without gaining velocity, as after write_positions.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/model/model.h"
#include "kernels/vectors.h"

namespace weft {

class Pins {
 public:
  static constexpr double kMostAcceleration = 200;  // m/s^2

  /// Before the first of some moves: remembers where the pins stand.
  void watch(const Model& model, const kernels::Vectors& position);
  /// All positions were replaced: nobody travels, but who moved may go on at the same speed.
  void put_down(const kernels::Vectors& position);
  /// All velocities were replaced: the next move is from rest.
  void rest();

  /// Everyone is taken along: moved(place), turned(velocity).
  template <class Moved, class Turned>
  void carry(Moved&& moved, Turned&& turned) {
    for (Pin& pin : pins_) {
      pin.from = moved(pin.from);
      pin.last = turned(pin.last);
    }
  }

  /// Those that travel start where they were, with their velocities. Whether some jumped.
  bool depart(double dt, kernels::Vectors& position, kernels::Vectors& velocity);
  /// After depart: everyone is where the caller wants them, at rest; arrived: the step was done.
  void stop(bool arrived, kernels::Vectors& position, kernels::Vectors& velocity);
  /// Whether one has moved in this step or in the last: if not, nobody is under way.
  bool moving() const { return moving_; }
  std::size_t bytes() const;

 private:
  struct Pin {
    std::uint32_t slot = 0;
    kernels::Vector from{}, to{};
    kernels::Vector last{}, speed{};  // of the last move and of this one
  };
  std::vector<Pin> pins_;  // empty until one is moved
  bool moving_ = false;    // see moving()
};

}  // namespace weft
