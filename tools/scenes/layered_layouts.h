/// The built-in scenes whose cloth is sheets that touch themselves and each other (scenes.h).
#pragma once

#include "tools/scenes/layout.h"
#include "tools/scenes/scene.h"

namespace weft::scenes {

// Options are within their ranges.
Layout stack(const Options& options);
Layout fold(const Options& options);
Layout curtain(const Options& options);
Layout twist(const Options& options);
Layout ribbon(const Options& options);
Layout funnel(const Options& options);

}  // namespace weft::scenes
