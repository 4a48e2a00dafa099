/// A body in a substep as lanes read it.
#pragma once

#include <span>

#include "kernels/reference/bodies.h"
#include "kernels/simd/limit_data.h"

namespace weft {

/// faces: as many as the form of the body has. The frame refers to them and to the body. origin:
/// near to the cloth, in floats without rounding.
void write_frame(simd::BodyFrame& frame, std::span<simd::BodyFace> faces,
                 const reference::BodyMotion& body, kernels::Vector origin);

}  // namespace weft
