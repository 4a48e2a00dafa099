/// Vectors of the public headers and of the kernels, each as the other.
#pragma once

#include <weft/scene.h>

#include "kernels/vectors.h"

namespace weft {

inline kernels::Vector to_internal(Vec3 v) { return {v.x, v.y, v.z}; }
inline Vec3 to_public(kernels::Vector v) { return {v.x, v.y, v.z}; }

}  // namespace weft
