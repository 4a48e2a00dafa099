/// The direct solver, which finds all impulses of a step at once.
///
/// Along frozen directions n the impulses lambda that remove the errors e solve a linear system,
///
///     A lambda = e,     A = J M^-1 J^T,     then x -= M^-1 J^T lambda,
///
/// where the row of a constraint in J has +n at its end a and -n at its end b. Directions and
/// errors are renewed after each solve, which is Newton's method for the projection onto the
/// constraints and converges quadratically. Velocities need one solve, since the constraints are
/// linear in them.
///
///   direct_layout    the row of each constraint, and the places of its values
///   direct_fronts    the dense parts of the factor
///   direct_factor    A = L D L^T
///   direct_system    the data of one solve
///   direct_measure   directions, errors, the active set of ropes and contacts
///   direct_impulses  from errors to impulses to motion
///   direct_balance   whether impulses explain a motion
///   direct_bodies    spheres and particles of many constraints, as unknowns beside the matrix
///   direct_stiff     a second method, for masses that differ by hundreds
///
/// A spring gives way by softness = compliance / h^2 times what its impulses have come to: that is
/// added to its diagonal of A and taken off its error, and with it A is regular.
///
/// Newton's method fails where a step bends edges by much of their length, where masses differ by
/// thousands, and where A is singular and the errors are inconsistent (compressed straight chains).
/// Failure shows in errors that no longer fall, or in a motion that its impulses do not explain
/// (direct_balance.h). It is reported in LoopResult::failed, and the caller tries something else
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

  /// Moves x until every constraint and listed contact is within tolerance; if it fails, x is as
  /// before. Impulses of the round before are kept. LoopResult::iterations counts solves.
  ///
  /// With scheme rattle, impulses act along the directions at `start`. One factorisation serves for
  /// all solves, and each solve leaves the share 1 - cos theta of an error, where theta is the
  /// angle by which the constraint has turned. If this does not converge, x is useless.
  kernels::LoopResult solve_positions(const PositionTask& task, Team& team) override;
  /// Corrects v, or leaves it as it was. With `exact`, errors within the tolerance are also
  /// removed, by one solve.
  kernels::LoopResult correct_velocities(const VelocityTask& task, Team& team) override;
  std::size_t bytes() const override;

 private:
  kernels::LoopResult solve_from_prediction(const PositionTask& task);
  kernels::LoopResult solve_from_start(const PositionTask& task);
  DirectOutcome iterate(kernels::VectorsView x, kernels::VectorsView start,
                        const SphereContacts& contacts, int max_iterations,
                        kernels::LoopResult& result);
  DirectOutcome iterate_stiff(kernels::VectorsView x, const SphereContacts& contacts,
                              int max_iterations, kernels::LoopResult& result);
  DirectOutcome iterate_fixed(kernels::VectorsView x, kernels::VectorsView start,
                              const SphereContacts& contacts, kernels::LoopResult& result);
  DirectOutcome iterate_velocities(kernels::VectorsView x, kernels::VectorsView v,
                                   const SphereContacts& contacts, bool exact, int max_iterations,
                                   kernels::LoopResult& result);
  bool solve(kernels::VectorsView u, kernels::LoopResult& result);

  const Settings settings_;
  DirectSystem system_;
  DirectFactor factor_;
  DirectBodies bodies_;
  DirectBalance balance_;
  DirectStiff stiff_;
  kernels::Vectors start_;  // positions or velocities before an attempt
};

}  // namespace weft
