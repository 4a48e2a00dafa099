/// The interface of all solvers to a step.
///
///   sweeps/  the paper's impulse loop: one constraint after the other, on either backend
///   yarn/    whole chains of constraints at a time
///   direct/  every impulse at once, by a sparse factorisation
///
/// Small steps (small_steps/) advance a state by themselves: their prediction, sweep and velocities
/// are one formula.
#pragma once

#include "engine/measure/spring_laws.h"
#include "engine/parallel/team.h"
#include "engine/spheres/sphere_contacts.h"
#include "kernels/loop.h"
#include "kernels/vectors.h"

namespace weft {

/// Positions that are to be brought within tolerance of every constraint and listed contact.
struct PositionTask {
  kernels::VectorsView x;  // in: the prediction; out: the solution, or the nearest that was found
  kernels::VectorsView start;  // where the substep began
  SphereContacts& contacts;    // of which measuring uses the scratch
  double dt_substep = 0;       // s, of the substep
  bool along_start = false;    // impulses act along the directions at `start` (scheme rattle)
  bool first_round = true;     // contacts were found anew: accumulated impulses begin at 0
  int max_iterations = 1;
  SpringLaws* laws = nullptr;  // of a model with springs: in place of the lengths and tolerances of
                               // the model; the solver writes the multipliers
};

/// Velocities that are to be brought within the velocity tolerance, at the positions x.
struct VelocityTask {
  kernels::VectorsView x, v;
  const SphereContacts& contacts;
  bool exact = false;  // removes what is within tolerance as well (scheme rattle)
  int max_iterations = 1;
};

class ConstraintSolver {
 public:
  virtual ~ConstraintSolver() = default;
  /// LoopResult::failed: the error no longer fell. It may have converged nevertheless, if the
  /// solver aims at less than the tolerance.
  virtual kernels::LoopResult solve_positions(const PositionTask& task, Team& team) = 0;
  virtual kernels::LoopResult correct_velocities(const VelocityTask& task, Team& team) = 0;
  virtual std::size_t bytes() const = 0;
};

}  // namespace weft
