#include "engine/step/pins.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/erase_repeated.h"

namespace weft {

using kernels::Vector;
using kernels::Vectors;

void Pins::watch(const Model& model, const Vectors& position) {
  if (pins_.empty()) {
    std::vector<Pin> pins;  // all of them or, where memory runs out, none
    for (const std::uint32_t slot : model.pins) {
      pins.push_back({.slot = slot, .from = position[slot]});
    }
    pins_ = std::move(pins);
  }
  moving_ = true;
}

std::size_t Pins::index_of(std::uint32_t slot) const {
  const auto found = std::ranges::lower_bound(pins_, slot, {}, &Pin::slot);
  const bool is_there = found != pins_.end() && found->slot == slot;
  return is_there ? static_cast<std::size_t>(found - pins_.begin()) : pins_.size();
}

void Pins::teleport(const Vectors& position) {
  for (Pin& pin : pins_) pin.from = position[pin.slot];
  teleported_.clear();
}

void Pins::teleport(const Model& model, std::span<const std::uint32_t> particles,
                    std::span<const Vec3> places, Vectors& position) {
  const auto slot_of = [&](std::size_t i) { return model.ordering.slot_of[particles[i]]; };
  std::vector<Place> teleported = teleported_;  // all of them or, where memory runs out, none
  teleported.reserve(teleported.size() + particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const std::size_t pin = index_of(slot_of(i));
    teleported.push_back({slot_of(i), pin < pins_.size() ? pins_[pin].from : position[slot_of(i)]});
  }
  std::ranges::stable_sort(teleported, {}, &Place::slot);
  erase_repeated(teleported, &Place::slot);  // the first one counts
  teleported_ = std::move(teleported);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vector place{places[i].x, places[i].y, places[i].z};
    const std::size_t pin = index_of(slot_of(i));
    if (pin < pins_.size()) pins_[pin].from = place;
    position.set(slot_of(i), place);
  }
}

void Pins::undo_teleports(Vectors& position) const {
  for (const Place& place : teleported_) position.set(place.slot, place.before);
}

void Pins::rest() {
  for (Pin& pin : pins_) pin.last = {0, 0, 0};
}

void Pins::go_on_from(const Pins& from, const Model& its_model, const Model& model,
                      const Vectors& position) {
  for (const Place& place : from.teleported_) {
    const std::uint32_t slot = model.ordering.slot_of[its_model.ordering.particle_at[place.slot]];
    if (model.inverse_mass[slot] == 0) teleported_.push_back({slot, place.before});
  }
  std::ranges::sort(teleported_, {}, &Place::slot);
  if (from.pins_.empty()) return;
  watch(model, position);
  moving_ = from.moving_;
  for (Pin& pin : pins_) {
    const std::uint32_t particle = model.ordering.particle_at[pin.slot];
    const std::size_t i = from.index_of(its_model.ordering.slot_of[particle]);
    if (i == from.pins_.size()) continue;
    pin.from = from.pins_[i].from;
    pin.last = from.pins_[i].last;
  }
}

void Pins::depart(double dt, Vectors& position, Vectors& velocity) {
  if (!moving_) return;
  for (Pin& pin : pins_) {
    pin.to = position[pin.slot];
    pin.speed = (1 / dt) * (pin.to - pin.from);
    pin.before = velocity[pin.slot];
    position.set(pin.slot, pin.from);
    velocity.set(pin.slot, pin.speed);
  }
}

void Pins::stop(bool arrived, Vectors& position, Vectors& velocity) {
  if (arrived) teleported_.clear();
  if (!moving_) return;
  if (arrived) moving_ = false;
  for (Pin& pin : pins_) {
    position.set(pin.slot, pin.to);
    velocity.set(pin.slot, arrived ? Vector{0, 0, 0} : pin.before);
    if (!arrived) continue;
    pin.from = pin.to;
    pin.last = pin.speed;
    moving_ |= length(pin.speed) > 0;
  }
}

Vector Pins::last_velocity(std::uint32_t slot) const {
  const std::size_t i = index_of(slot);
  return i < pins_.size() ? pins_[i].last : Vector{0, 0, 0};
}

bool Pins::fit(const Model& model) const {
  const auto is_pin = [&](const Place& p) {
    return std::ranges::binary_search(model.pins, p.slot);
  };
  return (pins_.empty() || std::ranges::equal(pins_, model.pins, {}, &Pin::slot)) &&
         std::ranges::all_of(teleported_, is_pin) &&
         std::ranges::is_sorted(teleported_, std::less_equal{}, &Place::slot);
}

std::size_t Pins::bytes() const { return bytes_of(pins_) + bytes_of(teleported_); }

}  // namespace weft
