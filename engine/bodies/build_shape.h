/// Shapes of descriptions. Those that are built in sources of their names have legal values.
#pragma once

#include "engine/bodies/body_shape.h"

namespace weft {

BuiltShape build(const HeightField& field);
BuiltShape build(const Torus& torus);

}  // namespace weft
