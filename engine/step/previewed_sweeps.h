/// The original method as the paper has it (kernels/reference/previewed.h), in double: both ends of
/// a constraint are previewed at every visit. It is the baseline of `weft paper`, and no setting of
/// a Cloth: `weft paper` makes it the solver of a State on the reference backend.
#pragma once

#include "engine/solvers/constraint_solver.h"
#include "engine/solvers/sweeps/reference_solver.h"
#include "engine/step/state.h"

namespace weft {

class PreviewedSweeps final : public ConstraintSolver {
 public:
  explicit PreviewedSweeps(State& s);

  kernels::LoopResult solve_positions(const PositionTask& task, Team& team) override;
  /// As the paper's loop.
  kernels::LoopResult correct_velocities(const VelocityTask& task, Team& team) override;
  std::size_t bytes() const override { return reference_.bytes(); }

 private:
  State& s_;
  ReferenceSolver reference_;
};

}  // namespace weft
