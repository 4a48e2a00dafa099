/// Particles that went through a sphere within one step.
#pragma once

#include "engine/model/model.h"
#include "engine/spheres/sphere_contacts.h"
#include "kernels/simd/table.h"
#include "kernels/vectors.h"

namespace weft {

/// Whether one of two things that moved by up to `way` (m) each may have gone through the other.
bool may_have_passed(const Model& model, double way);

/// Contacts are found where particles are predicted, not on their way there: one that is in front
/// of a sphere before the step and behind it afterwards was in no contact, or in one that pushed it
/// out on the far side. This looks at the way, which is straight within a step. Returns the slot of
/// a particle that went through a sphere, deeper than a twentieth of the sum of their radii, or
/// kNoIndex. Only the scratch of the contacts is written.
std::uint32_t find_passage(const Model& model, const simd::Table& kernels,
                           kernels::VectorsView before, kernels::VectorsView after,
                           SphereContacts& contacts);

}  // namespace weft
