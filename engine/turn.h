/// A rotation of vectors.
#pragma once

#include "kernels/vectors.h"

namespace weft {

struct Turn {
  kernels::Vector x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  // columns of the matrix

  kernels::Vector operator()(kernels::Vector v) const { return v.x * x + v.y * y + v.z * z; }
};

}  // namespace weft
