/// Data of the kernels that look for near features: boxes, and pairs of features of meshes.
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
/// The known data of pairs when an interval begins.
struct PairMeasure {
  const PairBlock* pairs = nullptr;
  const float* points = nullptr;  // in quads
  const float* ways = nullptr;    // likewise: that the points are expected to take; the fourth is
                                  // what a point may come off it
  float reach = 0;                // m: a pair that may come nearer than this, but for that, is near
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
  const float* points = nullptr;
  float rounding = 0;  // m, of the distances: what is nearer is not judged by them
  PairSide* sides = nullptr;
  std::uint16_t* touching = nullptr;  // written: nearer than the thickness, or not as last seen
};
/// Whether features may have met between two states.
struct PairMoves {
  const PairBlock* pairs = nullptr;
  const float* moves = nullptr;                        // of the points, in quads
  const float (*distance)[kernels::kLanes] = nullptr;  // in the first state
  float rounding = 0;                                  // m, of the distances
  float most = 0;                                      // m: no corner moves more beside another one
  std::uint16_t* moved = nullptr;                      // written: by more than their distance
};
/// kLanes boxes; of those that are not used `low` is above `high`.
struct alignas(64) BoxCluster {
  float low[3][kernels::kLanes], high[3][kernels::kLanes];
};

/// The tube of a point: a box when it begins, and one when it ends. `middle` and `half` follow from
/// low and high; the fourth of `middle` is what these may be off by, in 2^-20.
struct alignas(64) PointTube {
  float low[2][4], high[2][4], middle[2][4], half[2][4];
};
/// Directions along which features of two triangles are to meet besides x, y and z, where tubes
/// begin and where they end: lanes 4 to 7 and 12 to 15. Others are 0.
inline constexpr std::size_t kReachLanes = 16;
struct alignas(64) ReachAxes {
  float x[kReachLanes]{}, y[kReachLanes]{}, z[kReachLanes]{};
};
/// The reach of a feature along x, y, z, an unused direction and the four axes: where tubes begin,
/// and where they end.
struct alignas(64) FeatureReach {
  float low[kReachLanes], high[kReachLanes];
};
/// The edge k leads from the corner k to the next one.
struct TriangleReaches {
  FeatureReach corner[3], edge[3], whole;
};
/// Which features of a triangle meet those of another one. Bits:
///   0        it and the other one
///   1 + k    its corner k and the other triangle
///   4 + k    the corner k of the other one and it
///   7 + 3 j + i    its edge i and the edge j of the other one
struct TriangleMeeting {
  const ReachAxes* axes = nullptr;
  const TriangleReaches* reaches = nullptr;     // of the triangle along these
  const PointTube* tubes = nullptr;             // of all points
  const std::uint32_t (*corners)[3] = nullptr;  // of each other triangle
  const std::uint16_t* wanted = nullptr;        // likewise: the features to look at
  std::uint16_t* met = nullptr;                 // written, likewise
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
