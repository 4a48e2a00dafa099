/// The motion from one pose to another in the time of a step.
#pragma once

#include <weft/body.h>

#include "engine/turn.h"
#include "kernels/reference/bodies.h"

namespace weft {

/// From one pose to another, in a straight line, and by turning about one axis by less than half a
/// turn.
class PoseTravel {
 public:
  PoseTravel() = default;
  /// Rotations are unit quaternions.
  PoseTravel(const Pose& from, const Pose& to);

  /// At a share of the way.
  reference::Placement at(double share) const;
  kernels::Vector way() const { return way_; }             // m
  kernels::Vector turn() const { return angle_ * axis_; }  // rad

 private:
  Rotation begins_{};
  kernels::Vector start_{}, way_{}, axis_{};
  double angle_ = 0;
};

/// The same rotation with the length 1.
Rotation normalized(const Rotation& rotation);
/// First b, then a.
Rotation product(const Rotation& a, const Rotation& b);
Rotation inverse(const Rotation& rotation);
/// By |turn| rad about the axis `turn`.
Rotation rotation_by(kernels::Vector turn);
Rotation rotation_of(const Turn& turn);
/// The turn of a rotation, by half a turn at most.
kernels::Vector turn_of(const Rotation& rotation);
reference::Placement placement_of(const Rotation& rotation, kernels::Vector centre);

}  // namespace weft
