/// The particles of small steps in double, as local passes, anchors and bodies see and move them;
/// in lanes: lane_points.h.
#pragma once

#include <vector>

#include "engine/solvers/small_steps/reference_small_steps.h"

namespace weft {

struct ReferenceSmallSteps::Points {
  kernels::VectorsView x, predicted, start;
  std::vector<std::uint32_t>& touched;
  std::vector<double>& multipliers;
  kernels::VectorsView v;
  double rate;                     // by which it settles
  const std::uint32_t* anchor_at;  // per slot, or null: anchors are left
  const AnchorClock& anchors;
  std::vector<reference::MembraneMultipliers>& of_membrane;
  ReferenceBodies* bodies;  // or null: they are left
  std::vector<Arrival>& arrived;
  kernels::VectorsView led_to;  // as simd::Flight has it

  bool is_mended() const { return led_to.x != x.x; }
  kernels::Vector position(std::uint32_t slot) const { return x[slot]; }
  kernels::Vector position_at_start(std::uint32_t slot) const { return start[slot]; }
  kernels::Vector settled(std::uint32_t slot) const {
    return v[slot] + rate * (led_to[slot] - predicted[slot]);
  }
  /// What has stopped it is no motion: it is predicted to be where it is.
  void put(std::uint32_t slot, kernels::Vector position, kernels::Vector velocity) const {
    x.set(slot, position);
    predicted.set(slot, led_to[slot]);
    v.set(slot, velocity);
  }
  void put_start(std::uint32_t slot, kernels::Vector position) const {
    if (is_mended()) {
      led_to.add(slot, position - start[slot]);
      predicted.set(slot, led_to[slot]);
    }
    start.set(slot, position);
  }
  kernels::Vector difference(std::uint32_t a, std::uint32_t b) const { return x[a] - x[b]; }
  void move(std::uint32_t slot, kernels::Vector by) const {
    x.add(slot, by);
    if (anchor_at != nullptr && anchor_at[slot] != kNoIndex) hold(slot, anchor_at[slot]);
    if (bodies != nullptr) grip(slot);
  }
  bool hold(std::uint32_t slot, std::uint32_t anchor) const {
    const reference::Held held = anchors.hold(anchor, x[slot], settled(slot));
    if (held.is_at_limit) put(slot, held.x, held.v);
    return held.is_at_limit;
  }
  bool grip(std::uint32_t slot) const;
  bool grip_by_bodies(std::uint32_t slot) const {
    kernels::Vector to = x[slot], velocity = settled(slot), from = start[slot];
    const TouchedSurface surface = bodies->hold(slot, from, to, velocity);
    if (!surface.is_there()) return false;
    put(slot, to, velocity);
    put_start(slot, from);
    if (bodies->begins_to_touch(slot)) arrived.push_back({slot, surface});
    return true;
  }
  void push(std::uint32_t slot, kernels::Vector by) const {
    move(slot, by);
    touched.push_back(slot);
  }
  kernels::Vector start_difference(std::uint32_t a, std::uint32_t b) const {
    return start[a] - start[b];
  }
  double multiplier(std::uint32_t c) const { return multipliers[c]; }
  void set_multiplier(std::uint32_t c, double to) const { multipliers[c] = to; }
  const reference::MembraneMultipliers& membrane_multipliers(std::uint32_t element) const {
    return of_membrane[element];
  }
  void set_membrane_multipliers(std::uint32_t element,
                                const reference::MembraneMultipliers& to) const {
    of_membrane[element] = to;
  }
};

}  // namespace weft
