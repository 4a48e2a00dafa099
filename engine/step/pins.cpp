#include "engine/step/pins.h"

#include <utility>

namespace weft {

using kernels::Vector;
using kernels::Vectors;

void Pins::watch(const Model& model, const Vectors& position) {
  if (pins_.empty()) {
    std::vector<Pin> pins;  // all of them or, where memory runs out, none
    for (std::uint32_t slot = 0; slot < model.slots(); ++slot) {
      if (!model.is_particle(slot) || model.inverse_mass[slot] != 0) continue;
      pins.push_back({.slot = slot, .from = position[slot]});
    }
    pins_ = std::move(pins);
  }
  moving_ = true;
}

void Pins::put_down(const Vectors& position) {
  for (Pin& pin : pins_) pin.from = position[pin.slot];
}

void Pins::rest() {
  for (Pin& pin : pins_) pin.last = {0, 0, 0};
}

bool Pins::depart(double dt, Vectors& position, Vectors& velocity) {
  if (!moving_) return false;
  bool jumped = false;
  for (Pin& pin : pins_) {
    pin.to = position[pin.slot];
    pin.speed = (1 / dt) * (pin.to - pin.from);
    if (length(pin.speed - pin.last) > kMostAcceleration * dt) {
      jumped = true;
      continue;
    }
    position.set(pin.slot, pin.from);
    velocity.set(pin.slot, pin.speed);
  }
  return jumped;
}

void Pins::stop(bool arrived, Vectors& position, Vectors& velocity) {
  if (!moving_) return;
  if (arrived) moving_ = false;
  for (Pin& pin : pins_) {
    position.set(pin.slot, pin.to);
    velocity.set(pin.slot, {0, 0, 0});
    if (!arrived) continue;
    pin.from = pin.to;
    pin.last = pin.speed;
    moving_ |= length(pin.speed) > 0;
  }
}

std::size_t Pins::bytes() const { return pins_.capacity() * sizeof(Pin); }

}  // namespace weft
