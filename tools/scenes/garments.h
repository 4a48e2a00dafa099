/// The built-in scenes that are clothes (scenes.h).
#pragma once

#include <weft/result.h>

#include "tools/scenes/layout.h"
#include "tools/scenes/pattern.h"
#include "tools/scenes/scene.h"

namespace weft::scenes {

Pattern tunic_pattern();
Pattern skirt_pattern();

/// The error says what is too coarse.
Result<Layout> tunic(const Options& options);
Result<Layout> skirt(const Options& options);
/// One that is worn over the tunic; its waist is fixed.
Result<Layout> outer_skirt(const Options& options);
/// The tunic as on a wearer: front and back apart, and without pins.
Result<Layout> worn_tunic(const Options& options);

}  // namespace weft::scenes
