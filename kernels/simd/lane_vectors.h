/// Vectors of particles that stand beside each other in memory.
#pragma once

#include "kernels/runs.h"

namespace weft::simd {

/// A vector in each lane.
struct alignas(64) LaneVectors {
  float x[kernels::kLanes], y[kernels::kLanes], z[kernels::kLanes];
};

}  // namespace weft::simd
