/// A body that wears the tunic, and walks.
#pragma once

#include <weft/result.h>

#include "tools/scenes/layout.h"
#include "tools/scenes/scene.h"

namespace weft::scenes {

/// The worn tunic on a body of capsules. The error says what is too coarse.
Result<Layout> dressed_wearer(const Options& options);
/// How the trunk of the body moves.
tools::PinMove walk_of_trunk();

}  // namespace weft::scenes
