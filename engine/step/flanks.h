/// The flanks of a tear: the elements at a particle that was split, and those at the new particle.
///
/// Both are in one place when a sheet is split, on no side of each other. So a broken seam joins
/// them, and they do not collide with each other until they are apart by the thickness and do not
/// cross. From then on they are borders of the cloth like others.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/step/state.h"

namespace weft {

/// Whether the cloth touches itself and has flanks that are still joined.
bool has_flanks(const Model& model);
/// The broken seams of flanks that are apart now, in ascending order.
std::vector<std::uint32_t> flanks_apart(const State& state);

}  // namespace weft
