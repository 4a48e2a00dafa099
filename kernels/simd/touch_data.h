/// What the kernel of touching pairs reads and writes (touches.h).
#pragma once

#include "kernels/simd/nearness_data.h"

namespace weft::simd {

/// Points that pairs have, in quads. A place is whole numbers of a unit from an origin, as bits, so
/// that differences of places are as exact as that, wherever they are; then follows the inverse
/// mass (1/kg), which is 0 for what pairs do not move.
struct TouchedPoints {
  float* places = nullptr;
  float* moves = nullptr;     // m, since the substep began
  float* speeds = nullptr;    // m/s
  float* came_out = nullptr;  // m, by which it has been moved where the substep began
  float unit = 0;             // m
};

/// kLanes pairs, no two of which move the same point; lanes that are not used have a point of their
/// own that nothing moves.
struct alignas(64) TouchBlock {
  /// Corners of the triangles beside the features, which tell whether these are nearer: beside the
  /// three edges of the triangle, each of which begins at its next corner; or beside the second
  /// edge, and beside the first.
  std::uint32_t beside[4][kernels::kLanes];
  float friction[kernels::kLanes];
  // reference::Grip, of the present substep:
  float pushed[kernels::kLanes], held[kernels::kLanes], stopped[kernels::kLanes],
      slowed[kernels::kLanes], came_out[kernels::kLanes];
  // Since they were set to 0: what loads the body, its moment about the body's first point, and
  // what the body did and friction took (J). And how fast the surface was (m/s).
  LaneVectors impulse, moment, velocity;
  float work[kernels::kLanes], friction_work[kernels::kLanes];
};

struct PairPush {
  const PairBlock* pairs = nullptr;
  PairSide* sides = nullptr;
  TouchBlock* touches = nullptr;
  TouchedPoints points{};
  std::uint32_t of_body = 0;  // a bit for each of the four points that loads a body
  float h = 0;                // s
  float momentum_share = 1;
  float least_weight = 0;  // of the largest inverse mass of a pair
  float lean = 0;          // the sine by which a neighbour may stand out
  float surely_apart = 0;  // m: who is nearer has no direction by floats
};
/// A bit per lane.
struct PushedPairs {
  std::uint32_t pushed = 0;
  std::uint32_t undecided = 0;  // nothing was done: floats do not tell what
};

}  // namespace weft::simd
