/// What went through a sphere within one step.
#pragma once

#include "engine/model.h"
#include "kernels/vectors.h"

namespace weft {

/// Contacts are found where particles are predicted, not on their way there: one that is in front
/// of a sphere before the step and behind it afterwards was in no contact. This looks at the way,
/// which is straight within a step. Returns the slot of a particle that went through a sphere
/// deeper than a contact is watched for, or kNoIndex.
std::uint32_t find_crossing(const Model& model, const kernels::Vectors& before,
                            const kernels::Vectors& after);

}  // namespace weft
