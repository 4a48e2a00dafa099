/// Which pairs may touch in this step. Contacts exist between the spheres of a scene and all other
/// particles; each is one more constraint behind the model's, a = the sphere.
#pragma once

#include "engine/state.h"

namespace weft {

/// Lists every pair whose predicted distance is below r1 + r2 plus a margin of a tenth of the
/// sphere's radius.
void find_contacts(State& state);

/// After a solve: lists the pairs that the solve pushed into each other from beyond the margin.
/// Returns how many; if any, the positions must be solved again.
std::size_t add_missed_contacts(State& state);

/// Deepest r1 + r2 - |a - b| over all sphere pairs, 0 if none overlaps.
double max_penetration(const Model& model, const kernels::Vectors& position);

}  // namespace weft
