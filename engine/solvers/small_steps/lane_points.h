/// Particles of small steps in lanes, one by one, as local passes move them.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/anchor_travel.h"
#include "engine/solvers/small_steps/arrivals.h"
#include "engine/solvers/small_steps/point_particles.h"
#include "engine/solvers/small_steps/simd_bodies.h"
#include "engine/solvers/small_steps/simd_membrane.h"
#include "engine/solvers/yarn/yarn_places.h"
#include "kernels/vectors.h"

namespace weft {

/// Positions for local passes: differences of base and of u, which are nearly exact.
struct LanePoints {
  const YarnPlaces& places;
  const float* base;
  float* u;
  float* predicted;
  float* u_start;
  std::vector<std::uint32_t>& touched;
  const std::vector<std::uint32_t>& multiplier_place;
  float* multipliers;
  float* v;
  double rate;                     // by which it settles
  const std::uint32_t* anchor_at;  // per slot, or null: anchors are left
  const AnchorClock& anchors;
  SimdMembrane& membrane;
  SimdBodies* bodies;  // or null: they are left
  std::vector<Arrival>& arrived;
  std::vector<VelocityJump>& velocity_jumps;
  float* led_to;  // simd::Flight

  bool is_mended() const { return led_to != u; }
  // Asked millions of times a second: a call took a tenth of local passes.
  [[gnu::always_inline]] double axis(const float* from, std::size_t a, std::size_t b) const {
    return static_cast<double>(base[a]) - static_cast<double>(base[b]) +
           (static_cast<double>(from[a]) - static_cast<double>(from[b]));
  }
  [[gnu::always_inline]] kernels::Vector between(const float* from, std::uint32_t slot_a,
                                                 std::uint32_t slot_b) const {
    const std::size_t a = places.of(slot_a), b = places.of(slot_b), next = places.stride;
    return {axis(from, a, b), axis(from, a + next, b + next),
            axis(from, a + 2 * next, b + 2 * next)};
  }
  [[gnu::always_inline]] kernels::Vector difference(std::uint32_t slot_a,
                                                    std::uint32_t slot_b) const {
    return between(u, slot_a, slot_b);
  }
  kernels::Vector start_difference(std::uint32_t slot_a, std::uint32_t slot_b) const {
    return between(u_start, slot_a, slot_b);
  }
  double multiplier(std::uint32_t c) const {
    return static_cast<double>(multipliers[multiplier_place[c]]);
  }
  void set_multiplier(std::uint32_t c, double to) const {
    multipliers[multiplier_place[c]] = static_cast<float>(to);
  }
  reference::MembraneMultipliers membrane_multipliers(std::uint32_t element) const {
    return membrane.multipliers(element);
  }
  void set_membrane_multipliers(std::uint32_t element,
                                const reference::MembraneMultipliers& to) const {
    membrane.set_multipliers(element, to);
  }
  void move(std::uint32_t slot, kernels::Vector by) const {
    std::size_t at = places.of(slot);
    for (const double change : {by.x, by.y, by.z}) {
      u[at] += static_cast<float>(change);
      at += places.stride;
    }
    if (anchor_at != nullptr && anchor_at[slot] != kNoIndex) hold(slot, anchor_at[slot]);
    if (bodies != nullptr) solve_contacts(slot);
  }
  /// At the end of the substep, and its velocity there.
  kernels::Vector place(const float* from, std::uint32_t slot) const {
    const std::size_t x = places.of(slot), y = x + places.stride, z = y + places.stride;
    const auto sum = [&](std::size_t at) {
      return static_cast<double>(base[at]) + static_cast<double>(from[at]);
    };
    return {sum(x), sum(y), sum(z)};
  }
  kernels::Vector position(std::uint32_t slot) const { return place(u, slot); }
  kernels::Vector position_at_start(std::uint32_t slot) const { return place(u_start, slot); }
  kernels::Vector vector(const float* from, std::uint32_t slot) const {
    const std::size_t x = places.of(slot), y = x + places.stride, z = y + places.stride;
    return {static_cast<double>(from[x]), static_cast<double>(from[y]),
            static_cast<double>(from[z])};
  }
  kernels::Vector settled(std::uint32_t slot) const {
    const std::size_t x = places.of(slot), y = x + places.stride, z = y + places.stride;
    const auto velocity = [&](std::size_t at) {
      return static_cast<double>(v[at]) + rate * static_cast<double>(led_to[at] - predicted[at]);
    };
    return {velocity(x), velocity(y), velocity(z)};
  }
  void move_to(std::uint32_t slot, kernels::Vector position) const { put_place(u, slot, position); }
  /// Its stop by contacts is no motion: it is predicted to be where it is.
  void put(std::uint32_t slot, kernels::Vector position, kernels::Vector velocity) const {
    std::size_t at = places.of(slot);
    for (const auto& [to, speed] :
         {std::pair{position.x, velocity.x}, std::pair{position.y, velocity.y},
          std::pair{position.z, velocity.z}}) {
      u[at] = static_cast<float>(to - static_cast<double>(base[at]));
      predicted[at] = led_to[at];
      v[at] = static_cast<float>(speed);
      at += places.stride;
    }
  }
  ParticleAtHand take(std::uint32_t slot) const {
    ParticleAtHand hand{.start = place(u_start, slot),
                        .x = place(u, slot),
                        .predicted = place(predicted, slot),
                        .v = vector(v, slot),
                        .is_mended = is_mended()};
    hand.led_to = hand.is_mended ? place(led_to, slot) : hand.x;
    return hand;
  }
  void put_back(std::uint32_t slot, const ParticleAtHand& hand) const {
    put_place(u, slot, hand.x);
    put_place(u_start, slot, hand.start);
    put_place(predicted, slot, hand.predicted);
    if (hand.is_mended) put_place(led_to, slot, hand.led_to);
    std::size_t at = places.of(slot);
    for (const double speed : {hand.v.x, hand.v.y, hand.v.z}) {
      v[at] = static_cast<float>(speed);
      at += places.stride;
    }
  }
  void put_place(float* to, std::uint32_t slot, kernels::Vector x) const {
    std::size_t at = places.of(slot);
    for (const double component : {x.x, x.y, x.z}) {
      to[at] = static_cast<float>(component - static_cast<double>(base[at]));
      at += places.stride;
    }
  }
  void hold(std::uint32_t slot, std::uint32_t anchor) const {
    const reference::Held held = anchors.hold(anchor, place(u, slot), settled(slot));
    if (held.is_at_limit) put(slot, held.x, held.v);
  }
  void solve_contacts(std::uint32_t slot) const;
  void solve_body_contacts(std::uint32_t slot) const;
  void push(std::uint32_t slot, kernels::Vector by) const {
    move(slot, by);
    touched.push_back(slot);
  }
};

/// The same as contacts with meshes see them.
using LaneParticles = PointParticles<LanePoints>;

inline void LanePoints::solve_body_contacts(std::uint32_t slot) const {
  if (bodies->clear_of(slot, position_at_start(slot), position(slot)) > 0) return;
  ParticleAtHand hand = take(slot);
  if (hold_by_bodies(*this, slot, hand)) put_back(slot, hand);
}

inline void LanePoints::solve_contacts(std::uint32_t slot) const {
  solve_body_contacts(slot);
  if (!bodies->has_meshes()) return;
  LaneParticles particles(*this);
  bodies->hold_by_meshes(slot, particles);
}

}  // namespace weft
