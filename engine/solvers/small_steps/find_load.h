/// Finds the load on the pins of a cloth (small_steps_load.h).
#pragma once

#include "engine/solvers/small_steps/small_steps_load.h"

namespace weft {

class Model;
struct SmallStepsLayout;

SmallStepsLoad find_load(const Model& model, const SmallStepsLayout& layout);

}  // namespace weft
