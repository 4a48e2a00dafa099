/// The paper's impulse loop as a solver, on either backend.
///
/// Along frozen directions a loop over contradictory constraints wanders about for ever: a taut
/// chain at the least kink is thrown far to its side, for there its linear errors have a solution.
/// With directions renewed before every pass each correction is a projection onto its own
/// constraint, and projections onto sets that do not meet settle. So where the true error, looked
/// at after every kPassesBetweenLooks passes, begins to stall, directions are renewed in every
/// pass, and the loop ends where it has stalled all the same.
#pragma once

#include <weft/weft.h>

#include <optional>

#include "engine/measure/measure.h"
#include "engine/model/model.h"
#include "engine/solvers/constraint_solver.h"
#include "engine/solvers/sweeps/reference_solver.h"
#include "engine/solvers/sweeps/simd_solver.h"
#include "kernels/simd/table.h"

namespace weft {

class Sweeps final : public ConstraintSolver {
 public:
  Sweeps(const Model& model, const Settings& settings, const simd::Table& table, Measure& measure);

  kernels::LoopResult solve_positions(const PositionTask& task, Team& team) override;
  kernels::LoopResult correct_velocities(const VelocityTask& task, Team& team) override;
  std::size_t bytes() const override;

 private:
  kernels::LoopResult sweep(const PositionTask& task, bool first, const kernels::LoopLimits& limits,
                            Team& team);

  const Settings settings_;
  Measure& measure_;
  std::optional<ReferenceSolver> reference_;
  std::optional<SimdSolver> simd_;
};

}  // namespace weft
