/// The built-in scenes of cloth that has a material (scenes.h).
#pragma once

#include <weft/mesh.h>

namespace weft::scenes {

/// size: at least 2.
Result<SceneDescription> flag_of(int size, const Material& material);
Result<SceneDescription> drape_of(int size, const Material& material);

}  // namespace weft::scenes
