/// Double positions as two floats in quads (quads.h): base is the position rounded, u what that
/// lost.
#pragma once

#include "kernels/simd/lanes.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

void split_positions(kernels::VectorsView x, Displacements base, Displacements u, std::size_t first,
                     std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    const double at[3] = {x.x[i], x.y[i], x.z[i]};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto rounded = static_cast<float>(at[axis]);
      base.x[4 * i + axis] = rounded;
      u.x[4 * i + axis] = static_cast<float>(at[axis] - static_cast<double>(rounded));
    }
  }
}

/// x keeps the bits that two floats cannot hold, and all of them where u has not changed.
void join_positions(kernels::VectorsView x, Displacements base, Displacements u, std::size_t first,
                    std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    double* const at[3] = {x.x + i, x.y + i, x.z + i};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto before = static_cast<float>(*at[axis] - static_cast<double>(base.x[4 * i + axis]));
      *at[axis] += static_cast<double>(u.x[4 * i + axis]) - static_cast<double>(before);
    }
  }
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
