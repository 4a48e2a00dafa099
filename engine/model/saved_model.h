/// Models as bytes (weft/scene.h).
#pragma once

#include <weft/scene.h>

#include <cstdint>

namespace weft {

/// A hash of all that the model was built from, and of where its particles stand in memory.
std::uint64_t fingerprint(const Model& model);

}  // namespace weft
