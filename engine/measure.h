/// What is measured on a state: always from positions and velocities, never from the solver.
#pragma once

#include <weft/weft.h>

#include "engine/model.h"

namespace weft {

/// | |a-b| - rest | / rest over all active constraints; a slack rope has none.
Strain measure_strain(const Model& model, const kernels::Vectors& position);
Energy measure_energy(const Model& model, kernels::Vector gravity, const kernels::Vectors& position,
                      const kernels::Vectors& velocity);
/// Whether all components, and the squared distances between any two vectors, are finite.
bool all_finite(const kernels::Vectors& vectors);
/// The index of the first of which that is not true; the size if there is none.
std::size_t first_not_finite(const kernels::Vectors& vectors);

}  // namespace weft
