/// Whether two states are the same bits (Cloth::state_hash).
#pragma once

#include <cstdint>

#include "engine/step/state.h"

namespace weft {

/// FNV-1a over the bits of all positions and velocities, in the description's order.
std::uint64_t state_hash(const State& state);

}  // namespace weft
