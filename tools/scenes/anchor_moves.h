/// How the anchors of a scene move: as its pins do (pin_moves.h), and their normals turn.
#pragma once

#include <weft/weft.h>

#include <span>
#include <vector>

#include "tools/scenes/pin_moves.h"

namespace weft::tools {

class MovedAnchors {
 public:
  MovedAnchors(std::span<const PinMove> moves, const Cloth& cloth);
  bool any() const { return any_; }
  /// Sends all to where they are at `time`, with Cloth::move_anchors.
  Result<void> send(Cloth& cloth, double time) const;

 private:
  std::span<const PinMove> moves_;
  std::vector<Vec3> points_, normals_;  // of all anchors, without the moves
  bool any_ = false;
};

}  // namespace weft::tools
