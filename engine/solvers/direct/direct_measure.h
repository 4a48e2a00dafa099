/// Directions and errors of all constraints and contacts at given positions, and the active set:
/// which of the one-sided take part. A rope that is taut, a contact that overlaps, or one that has
/// accumulated an impulse in this step, takes part as an equation.
#pragma once

#include "engine/solvers/direct/direct_system.h"

namespace weft {

/// Each returns the largest error in tolerances, infinite if an error is not a number. Scheme
/// rattle takes the directions of constraints at `start`, if given, instead of x; contacts come
/// about within a step and act along their directions at x.
double measure_positions(DirectSystem& system, kernels::VectorsView x, kernels::VectorsView start,
                         const ContactStore& contacts);
double measure_velocities(DirectSystem& system, kernels::VectorsView x, kernels::VectorsView v,
                          const ContactStore& contacts);

}  // namespace weft
