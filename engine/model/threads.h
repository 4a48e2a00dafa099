/// Threads of a cloth: constraints that are no part of its triangles, and lie where they may touch
/// something all along their length.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/model/model.h"

namespace weft {

/// Pairs of slots, by the law that SceneDescription::surface tells.
std::vector<std::array<std::uint32_t, 2>> find_threads(const Model& model);
/// The same as pairs of particles.
std::vector<std::array<std::uint32_t, 2>> threads_of(const Model& model);

}  // namespace weft
