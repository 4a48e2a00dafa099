/// Fixed particles that the caller moves (Cloth::move_fixed).
///
/// A pin travels in a straight line through the whole of the next step: it has a velocity while
/// that lasts, the prediction moves it, and the velocity loop takes it along.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/saving/archive.h"
#include "kernels/vectors.h"

namespace weft {

class Pins {
 public:
  /// Before the first of some moves: remembers where the pins stand.
  void watch(const Model& model, const kernels::Vectors& position);
  /// All positions were replaced: no pin travels, but one that moved may go on at the same speed.
  void teleport(const kernels::Vectors& position);
  /// Teleports these fixed particles, one after the other.
  void teleport(const Model& model, std::span<const std::uint32_t> particles,
                std::span<const Vec3> places, kernels::Vectors& position);
  /// Whether one was teleported since the last step.
  bool were_teleported() const { return !teleported_.empty(); }
  /// Moves those that were teleported to where they stood when the last step ended.
  void undo_teleports(kernels::Vectors& position) const;
  /// All velocities were replaced: no pin has moved.
  void rest();
  /// Goes on from those of another model of the same particles; position: in the new slots.
  void go_on_from(const Pins& from, const Model& its_model, const Model& model,
                  const kernels::Vectors& position);

  /// All pins are taken along: moved(place), turned(velocity).
  template <class Moved, class Turned>
  void carry(Moved&& moved, Turned&& turned) {
    for (Pin& pin : pins_) {
      pin.from = moved(pin.from);
      pin.last = turned(pin.last);
    }
    for (Place& place : teleported_) place.before = moved(place.before);
  }

  /// Those that travel start where they were, with their velocities.
  void depart(double dt, kernels::Vectors& position, kernels::Vectors& velocity);
  /// After depart: all pins are where the caller wants them. arrived: the step was done, and they
  /// are at rest; else all is as it was before.
  void stop(bool arrived, kernels::Vectors& position, kernels::Vectors& velocity);
  /// Whether one has moved in this step or in the last: if not, no pin is under way.
  bool moving() const { return moving_; }
  /// In the last step.
  kernels::Vector last_velocity(std::uint32_t slot) const;
  std::size_t bytes() const;
  friend void visit_fields(Is<Pins> auto& part, auto& archive) {
    auto& [pins, moving, teleported] = part;
    archive(pins, moving, teleported);
  }
  /// Whether those that were read are the model's.
  bool fit(const Model& model) const;

 private:
  struct Pin {
    std::uint32_t slot = 0;
    kernels::Vector from{}, to{};
    kernels::Vector last{}, speed{};  // of the last move and of this one
    kernels::Vector before{};         // its velocity when it departed

    friend void visit_fields(Is<Pin> auto& pin, auto& archive) {
      auto& [slot, from, to, last, speed, before] = pin;  // depart() sets to, speed and before
      archive(slot, from, last);
    }
  };
  /// A pin that was teleported, and where it stood before.
  struct Place {
    std::uint32_t slot = 0;
    kernels::Vector before{};

    friend void visit_fields(Is<Place> auto& place, auto& archive) {
      auto& [slot, before] = place;
      archive(slot, before);
    }
  };
  /// In pins_; its size if none is watched there.
  std::size_t index_of(std::uint32_t slot) const;

  std::vector<Pin> pins_;          // by slots; empty until one is moved
  bool moving_ = false;            // see moving()
  std::vector<Place> teleported_;  // by slots, each pin once
};

}  // namespace weft
