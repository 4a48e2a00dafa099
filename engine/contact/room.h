/// The room between bodies. Where two of them are against each other, and leave less than both
/// their thicknesses, no place is at both distances. Each body then yields a part of its distance,
/// in proportion to its thickness, so that what lies between them has a place where neither pushes
/// it into the other. It keeps the place that it has, goes to that one by and by, and moves with
/// both as they close on each other. Where bodies overlap they yield more than their thickness, and
/// what is between them is inside of both.
///
/// Two pushes that undo each other in turn would otherwise tear the cloth to and fro, and friction
/// would take energy from nothing.
#pragma once

#include <weft/scene.h>

#include <cstdint>
#include <span>
#include <vector>

#include "engine/bodies/body_clock.h"

namespace weft {

/// The claim of a body on a place when a substep begins.
struct Claim {
  std::uint32_t body = 0;    // of the clock
  kernels::Vector normal{};  // out of the body
  double distance = 0;       // m, from its surface; negative: inside
  double thickness = 0;      // m, that are asked for
  kernels::Vector velocity{};
};

enum class SubstepMoment { start, end };

/// The claim of a body in a closed form, whose thickness is more by the radius of a particle. x:
/// where that is then. When the substep ends, nothing moves any more.
Claim claim_of(const BodyClock& clock, std::size_t body, kernels::Vector x, double radius,
               SubstepMoment when = SubstepMoment::start);

class Room {
 public:
  using Yield = reference::Yield;
  struct Entry {
    std::uint32_t slot = 0, body = 0, next = 0;
    Yield yield{};
  };

  /// Begins a frame.
  void begin(std::size_t slots);
  void begin_substep();
  /// Particles at a place, or around one, that both claim.
  void share(const Claim& a, const Claim& b, double h, std::span<const std::uint32_t> slots);
  /// The same of each two.
  void share(std::span<const Claim> claims, double h, std::uint32_t slot);
  bool any() const { return !entries_.empty(); }
  std::span<const Entry> entries() const { return entries_; }
  /// The yield of the body to a particle.
  Yield of(std::uint32_t slot, std::uint32_t body) const;
  std::size_t bytes() const;

 private:
  void add(std::uint32_t slot, std::uint32_t body, const Yield& yield);

  std::vector<std::uint32_t> first_;  // per slot
  std::vector<Entry> entries_;
};

}  // namespace weft
