/// Moves a whole cloth without accelerating it (Cloth::carry).
#pragma once

#include "engine/step/state.h"
#include "engine/turn.h"

namespace weft {

/// x -> about + R (x - about) + translation: the share of a motion, of its translation and of its
/// angle.
struct Carriage {
  Turn turned;  // R
  kernels::Vector about{}, to{};

  Carriage(const RigidMotion& motion, double share);
  kernels::Vector moved(kernels::Vector p) const { return to + turned(p - about); }
};

/// Moves and turns all of the state that has a place or a direction. Returns the slot of a particle
/// that would leave the range of numbers, and then nothing is changed; or kNoIndex.
std::uint32_t carry(State& state, const Carriage& by);

}  // namespace weft
