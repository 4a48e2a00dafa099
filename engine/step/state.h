/// The mutable part of a cloth: the state, the contacts of the present step, the solver's memory.
///
/// Which stage writes what:
///   predict             solved (and contacts, which choose_substeps looks for)
///   find_contacts       contacts
///   solve_positions     solved (and contacts, by those that it ran into; next_velocity is room)
///   commit              next_velocity, kicks
///   correct_velocities  next_velocity, kicks
///   report              nothing
/// position and velocity change only when a substep is known to be finite (transaction.h), where
/// pins set out and arrive (pins.h), and where a start is projected (substeps.cpp); all of it is
/// taken back when a later substep of the same step is not finite.
#pragma once

#include <weft/weft.h>

#include <memory>
#include <optional>
#include <vector>

#include "engine/contacts/contacts.h"
#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/solvers/direct/direct_solver.h"
#include "engine/solvers/small_steps/reference_small_steps.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/solvers/sweeps/reference_solver.h"
#include "engine/solvers/sweeps/simd_measure.h"
#include "engine/solvers/sweeps/simd_solver.h"
#include "engine/solvers/yarn/yarn_solver.h"
#include "engine/step/pins.h"
#include "engine/step/trouble.h"
#include "kernels/kicks.h"
#include "kernels/vectors.h"

namespace weft {

struct State {
  std::shared_ptr<const Model> model;
  Settings settings;  // isa, solver, substeps and velocity_correction resolved

  kernels::Vectors position, velocity;
  kernels::Vectors force;  // empty: none
  kernels::Vector gravity;
  kernels::Vectors solved;  // where the position loop works; the next positions
  kernels::Vectors next_velocity;
  kernels::Vectors start_position, start_velocity;  // of the step
  kernels::Vectors substep_start;                   // positions; small steps with contacts only
  ContactStore contacts;
  Pins pins;
  Trouble trouble;
  bool placed = true;      // positions were given, not stepped to: they may violate constraints
  double lost_energy = 0;  // J, of small steps, lately (energy.h)
  double last_dt = 0;      // of the last step; 0: none yet, or it did not converge

  std::vector<kernels::Kicks> kicks;  // per stretch of slots

  // The one of the chosen backend.
  std::optional<ReferenceSolver> reference;
  kernels::Vectors predicted;  // reference only
  /// The position loop is the original one as the paper has it (kernels/reference/previewed.h):
  /// with the reference, Gauss-Seidel and scheme paper. No setting of a Cloth: `weft paper` asks
  /// for it.
  bool previews = false;
  std::optional<SimdSolver> simd;
  std::optional<SimdMeasure> measure;           // simd only
  std::optional<SmallStepsSolver> small_steps;  // with Solver::small_steps, on either backend
  std::optional<ReferenceSmallSteps> reference_small_steps;
  // The chosen solver, if it is not Gauss-Seidel. Where it gives up sweeps of the backend answer,
  // or direct behind yarns.
  std::optional<YarnSolver> yarn;      // with Solver::yarn
  std::optional<DirectSolver> direct;  // with Solver::direct, and behind yarns of uneven masses
  const simd::Table* kernels = nullptr;
  std::shared_ptr<Team::Meeting> meeting = Team::make_meeting();  // of the team of each step

  State(std::shared_ptr<const Model> model, const Settings& settings);
  /// Goes on from another state of the same model.
  void copy(const State& from);
  std::size_t bytes() const;
};

}  // namespace weft
