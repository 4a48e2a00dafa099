/// Cloth that is inside a body when a run begins.
#pragma once

#include <weft/weft.h>

#include <cstddef>
#include <span>
#include <vector>

#include "tools/scenes/scene_body.h"

namespace weft::tools {

struct StartInside {
  std::size_t body = 0;       ///< by its place among all bodies
  std::size_t particles = 0;  ///< that are free, and no spheres
};

/// Of each body that has some, where bodies are at time 0. Particles that are no deeper than
/// `depth` (m) count as on the surface. Two-sided meshes have no inside.
std::vector<StartInside> starts_inside(const SceneDescription& scene,
                                       std::span<const SceneBody> bodies, double depth);

}  // namespace weft::tools
