/// From the layout of a scene to its particles and constraints: the one place where a built-in
/// cloth is given a material, or rigid edges.
#pragma once

#include "tools/scenes/layout.h"
#include "tools/scenes/scene.h"

namespace weft::scenes {

/// Of the material, by cloth_from_mesh; without one, of 1 kg, shared equally, and rigid edges.
Result<Scene> cloth_of(const Layout& layout, const Options& options);

}  // namespace weft::scenes
