/// What kernels read and write that look for what is near: boxes, and pairs of features of meshes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/runs.h"
#include "kernels/simd/lane_vectors.h"
#include "kernels/vectors.h"

namespace weft::simd {

/// kLanes pairs of features (distances.h): a point and a triangle, or two edges, by their points.
/// Lanes that are not used repeat another one.
struct alignas(64) PairBlock {
  std::uint32_t point[4][kernels::kLanes];
};
/// The share of a distance in floats that the true one is not below.
inline constexpr float kSurelyApart = 0.95f;
/// What is known of pairs when an interval begins.
struct PairMeasure {
  const PairBlock* pairs = nullptr;
  const float* points = nullptr;  // in quads
  const float* ways = nullptr;    // likewise: that the points are expected to take
  float reach = 0;                // m: who may come nearer than this is near
  float beyond = 0;               // of an edge: so far past its ends it may face another one
  float (*distance)[kernels::kLanes] = nullptr;  // written, per block
  std::uint16_t* near = nullptr;                 // written, per block, a bit per lane
};
/// On which side of each other the features of a block are.
struct alignas(64) PairSide {
  LaneVectors normal;  // from the second to the first, as last seen there
  float thickness[kernels::kLanes];
  std::uint32_t used = 0;  // a bit per lane; 16 above it: whether to be looked at in any case
};
struct PairTouch {
  const PairBlock* pairs = nullptr;
  const float* places = nullptr;  // of the points (touch_data.h)
  float unit = 0;                 // m
  PairSide* sides = nullptr;
  std::uint16_t* touching = nullptr;  // written: nearer than the thickness, or not as last seen
};
/// Whether features may have met between two states.
struct PairMoves {
  const PairBlock* pairs = nullptr;
  const float* moves = nullptr;                        // of the points, in quads
  const float (*distance)[kernels::kLanes] = nullptr;  // in the first state
  float rounding = 0;                                  // m, of the distances
  std::uint16_t* moved = nullptr;                      // written: by more than their distance
};
/// kLanes boxes; of those that are not used `low` is above `high`.
struct alignas(64) BoxCluster {
  float low[3][kernels::kLanes], high[3][kernels::kLanes];
};

/// Boxes around groups of kBoxed slots, from low to high; one without a particle reaches from
/// infinity to minus infinity. There are count, a multiple of kLanes.
inline constexpr std::size_t kBoxed = 256;
struct Boxes {
  kernels::VectorsView low, high;
  const double* reach = nullptr;  // largest of the group
  std::size_t count = 0;
};

}  // namespace weft::simd
