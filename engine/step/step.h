/// One time step: its substeps, and what becomes of them. From top to bottom:
///
///   Cloth::step              cloth.cpp      refuses a bad dt
///     step                   step.cpp       threads, pins on their way, the report
///       run_substeps         substeps.cpp   how many; a bad start; halves where one fails
///         substep            substep.cpp    one of them: the list of stages
///           solve_positions  solve.cpp      which solver, what answers for it, rounds of contacts
///             solvers/{reference,simd,yarn,direct}_solver
#pragma once

#include <weft/weft.h>

#include "engine/step/state.h"

namespace weft {

/// Advances the state by dt > 0, or leaves it as it was: where committed(status) is false, and
/// where it throws.
StepReport step(State& state, double dt);

}  // namespace weft
