/// Measures directions and errors of all constraints and contacts at given positions, and finds the
/// active set. A one-sided constraint takes part as an equation if it is a rope that is taut, a
/// contact that overlaps, or one that has accumulated an impulse in this step.
#pragma once

#include "engine/solvers/direct/direct_system.h"

namespace weft {

/// Both return the largest error in units of the tolerance; it is infinite if an error is not a
/// number. If `start` is given, for scheme rattle, the directions of constraints are those at
/// `start`; contacts come about within a step and always act along their directions at x.
double measure_positions(DirectSystem& system, kernels::VectorsView x, kernels::VectorsView start,
                         const SphereContacts& contacts);
double measure_velocities(DirectSystem& system, kernels::VectorsView x, kernels::VectorsView v,
                          const SphereContacts& contacts);

}  // namespace weft
