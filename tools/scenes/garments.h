/// Clothes of built-in scenes.
#pragma once

#include <weft/result.h>

#include "tools/scenes/layout.h"
#include "tools/scenes/pattern.h"
#include "tools/scenes/scene.h"

namespace weft::scenes {

Pattern tunic_pattern();
Pattern skirt_pattern();

/// The error says what is too coarse.
/// Flat, hanging from its shoulders.
Result<Layout> hung_tunic(const Options& options);
/// On its cone; its waist is fixed.
Result<Layout> fitted_skirt(const Options& options);
/// One that is worn over the tunic; its waist is fixed.
Result<Layout> outer_skirt(const Options& options);
/// The tunic as on a wearer: front and back apart, and without pins.
Result<Layout> worn_tunic(const Options& options);

}  // namespace weft::scenes
