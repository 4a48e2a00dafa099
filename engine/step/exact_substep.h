/// One substep by a solver of constraints, from top to bottom: predict, find contacts, solve
/// positions, set velocities, correct velocities, and judge the result.
#pragma once

#include "engine/step/attempt.h"
#include "engine/step/state.h"

namespace weft {

/// Computes the next state, in solved and next_velocity; position and velocity stay. is_predicted:
/// solved is the prediction already.
Trial exact_substep(State& s, const Attempt& attempt, double dt_substep, const Budget& budget,
                    bool is_predicted, StepReport& report, Team& team);

/// Brings solved onto the constraints; rounds go on while the solution runs into contacts that the
/// search had not listed.
kernels::LoopResult solve_positions(State& s, ConstraintSolver& solver, PositionTask task,
                                    StepReport& report, Team& team);

/// Brings next_velocity within the velocity tolerance, at the positions solved. Errors that the
/// solver leaves are for sweeps, which judge in double.
Status correct_velocities(State& s, ConstraintSolver& solver, bool exact, const Budget& budget,
                          StepReport& report, Team& team);

/// elastic_energy, of positions that no substep has led to: as a substep of dt_substep resolves it.
void find_elastic_energy(State& s, double dt_substep);

/// Lists the contacts that may occur at solved.
void find_contacts(State& s, StepReport& report);

}  // namespace weft
