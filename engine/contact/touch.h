/// A particle that touches a body where the last substep ended.
#pragma once

#include <weft/scene.h>

#include <cstdint>

#include "kernels/vectors.h"

namespace weft {

struct BodyTouch {
  std::uint32_t slot = 0, body = 0;   // the body's id
  double push = 0;                    // m, along the normal, in that substep
  kernels::Vector point{}, normal{};  // on the surface
};

}  // namespace weft
