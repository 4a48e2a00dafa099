/// Makes the layout of small steps (small_steps_layout.h).
#pragma once

#include "engine/solvers/small_steps/small_steps_layout.h"

namespace weft {

SmallStepsLayout make_small_steps_layout(const Model& model);
/// That of a model which differs from `layout`'s in the compliances of bending elements alone.
SmallStepsLayout with_bending_of(const Model& model, SmallStepsLayout layout);

}  // namespace weft
