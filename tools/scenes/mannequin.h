/// The built-in scenes of a tunic on a body that walks (scenes.h).
#pragma once

#include <weft/result.h>

#include "tools/scenes/layout.h"
#include "tools/scenes/scene.h"

namespace weft::scenes {

/// The error says what is too coarse.
Result<Layout> mannequin(const Options& options);
Result<Layout> mannequin_mesh(const Options& options);
Result<Layout> outfit(const Options& options);

}  // namespace weft::scenes
