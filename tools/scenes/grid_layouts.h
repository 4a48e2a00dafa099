/// The built-in scenes whose cloth is a grid (scenes.h).
#pragma once

#include "tools/scenes/layout.h"
#include "tools/scenes/scene.h"

namespace weft::scenes {

// Options are within their ranges.
Layout hang(const Options& options);
Layout hang_sphere(const Options& options);
Layout sphere_drop(const Options& options);
Layout corners(const Options& options);
Layout banner(const Options& options);
Layout four_pins(const Options& options);
Layout flag(const Options& options);
Layout drape(const Options& options);
Layout table(const Options& options);
Layout cushion(const Options& options);
Layout rings(const Options& options);

}  // namespace weft::scenes
