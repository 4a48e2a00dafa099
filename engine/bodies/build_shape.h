/// Shapes of descriptions.
#pragma once

#include "engine/bodies/body_shape.h"
