/// Position and velocity constraints, by the solver that the settings name.
#pragma once

#include <cstdint>

#include "engine/measure.h"
#include "engine/state.h"

namespace weft {

/// What is done where the chosen solver gives up: the substep is left to be done in halves, or
/// Gauss-Seidel sweeps go on from there.
enum class OnFailure : std::uint8_t { give_up, sweep };

/// One way to try a substep.
struct Attempt {
  double h = 0;
  int most_iterations = 1;
  OnFailure on_failure = OnFailure::sweep;
  kernels::VectorsView start{};  // with scheme rattle: where the directions are
};

/// Moves solved until every constraint is within tolerance. Returns whether the solver gave up.
bool solve_positions(State& s, const Attempt& attempt, StepReport& report, Team& team);
/// The velocity loop: changes next_velocity.
void correct_velocities(State& s, StepReport& report, Team& team);

/// True errors at x.
Strain strain_at(State& s, kernels::Vectors& x, Team& team);
double penetration_at(State& s, kernels::Vectors& x);

}  // namespace weft
