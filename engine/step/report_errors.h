/// The errors of constraints in a report.
#pragma once

#include "engine/step/state.h"

namespace weft {

/// Strain of rigid constraints, the largest. Springs that are out of shape are no error.
double largest_rigid_strain(const State& s);

/// The true errors at x, where a step ends or where it begins. The error of the laws of springs is
/// told by their solver.
void report_errors(State& s, kernels::Vectors& x, bool ends, StepReport& report, Team& team);

}  // namespace weft
