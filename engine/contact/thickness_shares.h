/// Narrow gaps between bodies. If two bodies face each other across a gap smaller than the sum of
/// their thicknesses, no place in the gap is at both distances. Each body is then treated as
/// thinner, in proportion to its thickness, so that cloth between them has a place where neither
/// body pushes it into the other. The cloth approaches that place slowly, and moves with both
/// bodies as they close on each other. Where bodies overlap they become thinner by more than their
/// thickness, and the cloth between them is inside both.
///
/// Without this two contacts would undo each other's corrections in turn: the cloth would shake,
/// and friction would gain energy from nothing.
#pragma once

#include <weft/scene.h>

#include <cstdint>
#include <span>
#include <vector>

#include "engine/bodies/body_clock.h"

namespace weft {

/// The distance between a place and a body when a substep begins.
struct BodyClearance {
  std::uint32_t body = 0;    // of the clock
  kernels::Vector normal{};  // out of the body
  double distance = 0;       // m, from its surface; negative: inside
  double thickness = 0;      // m, the distance that the body is to keep
  kernels::Vector velocity{};
};

enum class SubstepMoment { start, end };

/// The clearance of a particle at x from a body in a closed form. The radius of the particle adds
/// to the thickness. When the substep ends, nothing moves any more.
BodyClearance clearance_of(const BodyClock& clock, std::size_t body, kernels::Vector x,
                           double radius, SubstepMoment when = SubstepMoment::start);

/// How much thinner each body is treated at each particle.
class ThicknessShares {
 public:
  using Thinning = reference::Thinning;
  struct Entry {
    std::uint32_t slot = 0, body = 0, next = 0;
    Thinning thinning{};
  };

  /// Begins a frame.
  void begin(std::size_t slots);
  void begin_substep();
  /// Shares the gap between two bodies at a place, for the particles there.
  void share(const BodyClearance& a, const BodyClearance& b, double dt_substep,
             std::span<const std::uint32_t> slots);
  /// The same of each two of these.
  void share(std::span<const BodyClearance> clearances, double dt_substep, std::uint32_t slot);
  bool any() const { return !entries_.empty(); }
  std::span<const Entry> entries() const { return entries_; }
  /// The thinning of the body at a particle.
  Thinning of(std::uint32_t slot, std::uint32_t body) const;
  std::size_t bytes() const;

 private:
  void add(std::uint32_t slot, std::uint32_t body, const Thinning& thinning);

  std::vector<std::uint32_t> first_;  // per slot
  std::vector<Entry> entries_;
};

}  // namespace weft
