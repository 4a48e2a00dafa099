/// The paths of free spheres.
#pragma once

#include <cstdint>

namespace weft {

class Model;

/// Whether a free sphere may come to touch the cloth: its way in free flight, from the places and
/// velocities of the description, leads through all that the cloth can reach from its pins. Where
/// nothing is known of either the answer is yes.
bool may_come_to_cloth(const Model& model, std::uint32_t sphere);

}  // namespace weft
