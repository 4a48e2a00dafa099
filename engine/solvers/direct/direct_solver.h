/// The direct solver: every impulse of a step at once.
///
/// Along frozen directions n the impulses lambda that remove the errors e solve a linear system,
///
///     A lambda = e,     A = J M^-1 J^T,     then x -= M^-1 J^T lambda,
///
/// J having +n at a constraint's end a and -n at its end b. Renewing directions and errors after
/// each solve is Newton's method for the projection onto the constraints: the error is squared
/// each time. Velocities need one solve, for they are linear.
///
///   direct_layout    which constraint is which row, and where its values stand
///   direct_fronts    the dense parts of the factor
///   direct_factor    A = L D L^T
///   direct_system    what one solve works on
///   direct_measure   directions, errors, the active set of ropes and contacts
///   direct_impulses  errors become impulses become motion
///   direct_balance   whether impulses explain a motion
///   direct_bodies    spheres and particles of many constraints, unknowns beside the matrix
///   direct_stiff     an attempt for masses that differ by hundreds
///
/// Newton's method fails where a step bends edges by much of their length, where masses differ by
/// thousands, and where A is singular and the errors inconsistent (compressed straight chains).
/// That is seen by errors that no longer fall, or by a motion that its impulses do not explain
/// (direct_balance.h). The caller is told (LoopResult::failed), and tries something else
/// (engine/step/plan.h).
#pragma once

#include <cstdint>

#include "engine/solvers/constraint_solver.h"
#include "engine/solvers/direct/direct_balance.h"
#include "engine/solvers/direct/direct_bodies.h"
#include "engine/solvers/direct/direct_factor.h"
#include "engine/solvers/direct/direct_stiff.h"
#include "engine/solvers/direct/direct_system.h"
#include "kernels/loop.h"

namespace weft {

class DirectSolver final : public ConstraintSolver {
 public:
  DirectSolver(const Model& model, const Settings& settings, const simd::Table& kernels);

  /// Moves x until every constraint and listed contact is within tolerance; where it fails x stays.
  /// Impulses are kept from the round before. LoopResult::iterations counts solves.
  ///
  /// With scheme rattle the directions at `start` do not turn: one factorisation, and each solve
  /// takes off an error about 1 - cos of what the constraint turned by. Where that does not
  /// converge x is worth nothing.
  kernels::LoopResult solve_positions(const PositionTask& task, Team& team) override;
  /// Corrects v, or leaves it; with `exact` also what is within tolerance, once.
  kernels::LoopResult correct_velocities(const VelocityTask& task, Team& team) override;
  std::size_t bytes() const override;

 private:
  kernels::LoopResult solve_from_start(const PositionTask& task);
  DirectOutcome iterate(kernels::VectorsView x, kernels::VectorsView start,
                        const ContactStore& contacts, int max_iterations,
                        kernels::LoopResult& result);
  DirectOutcome iterate_stiff(kernels::VectorsView x, const ContactStore& contacts,
                              int max_iterations, kernels::LoopResult& result);
  DirectOutcome iterate_fixed(kernels::VectorsView x, kernels::VectorsView start,
                              const ContactStore& contacts, kernels::LoopResult& result);
  DirectOutcome iterate_velocities(kernels::VectorsView x, kernels::VectorsView v,
                                   const ContactStore& contacts, bool exact, int max_iterations,
                                   kernels::LoopResult& result);
  bool solve(kernels::VectorsView u, kernels::LoopResult& result);

  const Settings settings_;
  DirectSystem system_;
  DirectFactor factor_;
  DirectBodies bodies_;
  DirectBalance balance_;
  DirectStiff stiff_;
  kernels::Vectors start_;  // where an attempt begins
};

}  // namespace weft
