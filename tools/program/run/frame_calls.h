/// All that a run does to its cloth between two steps, as the cloth gets it.
#pragma once

#include <weft/weft.h>

#include <vector>

#include "tools/scenes/body_moves.h"
#include "tools/scenes/pin_moves.h"

namespace weft::tools {

struct FrameCalls {
  std::vector<PlacedPin> pins = {};
  std::vector<PosedBody> bodies = {};
  std::vector<DeformedBody> deformed = {};
};

/// Those that bring pins and bodies to where they are at `time`.
FrameCalls calls_at(const MovedPins& pins, const MovedBodies& bodies, const Cloth& cloth,
                    double time);
/// In order. The error is that of the first call that is refused.
Result<void> apply(const FrameCalls& calls, Cloth& cloth);

}  // namespace weft::tools
