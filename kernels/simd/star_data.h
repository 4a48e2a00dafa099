/// The data that kernels of stars (stars.h) read and write. A star is the triangles around a point.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/runs.h"

namespace weft::simd {

/// The area vector of a triangle, in m^2, while its corners move on straight lines: a polynomial of
/// second degree in time, by its coefficients in Bernstein's form.
struct alignas(64) TriangleTurn {
  float area[3][4];  // quads
  float least[4];    // m^2: so much of the area is along the direction of a star that does not fold
};

struct TriangleTurns {
  const std::uint32_t (*corners)[3] = nullptr;  // per triangle
  const float* least_area = nullptr;            // m^2, per triangle
  const float* starts = nullptr;                // of points, in quads
  const float* ways = nullptr;                  // likewise
  float share = 1;                              // of the least areas
  float rounding = 0;                           // m, of places
  TriangleTurn* turns = nullptr;                // written
};

/// kLanes stars, by rows that have a triangle of each. A star with fewer triangles than another one
/// repeats its own.
struct StarBlock {
  std::uint32_t first = 0, last = 0;  // rows
};
struct StarFold {
  const StarBlock* blocks = nullptr;
  const std::uint32_t (*rows)[kernels::kLanes] = nullptr;  // the number of a triangle, times four
  const TriangleTurn* turns = nullptr;
  std::uint16_t* folded = nullptr;  // written, per block, a bit per lane
};

}  // namespace weft::simd
