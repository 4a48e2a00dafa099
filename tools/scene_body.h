/// A body of a scene.
#pragma once

#include <weft/weft.h>

#include <optional>

#include "tools/pin_moves.h"

namespace weft::tools {

/// It begins at a pose and moves as pins do: x goes to where place_at() takes it.
struct SceneBody {
  ShapeDescription shape;
  Pose pose{};
  double thickness = Body{}.thickness;  ///< m
  double friction = Body{}.friction;
  std::optional<PinMove> move = {};  ///< of no particles
};

}  // namespace weft::tools
