/// Position and velocity constraints, by the solver that the settings name.
#pragma once

#include <algorithm>
#include <cstdint>

#include "engine/step/measure.h"
#include "engine/step/state.h"

namespace weft {

/// What is done where the chosen solver gives up. halve: nothing, and the caller does the substep
/// in halves, even if the result is within tolerance, but short of the solver's goal. leave:
/// nothing, unless the result is within tolerance. sweep: Gauss-Seidel sweeps take over.
enum class OnFailure : std::uint8_t { halve, leave, sweep };

/// One way to try a substep.
struct Attempt {
  double h = 0;
  int most_iterations = 1;
  int most_velocity_iterations = 1;
  OnFailure on_failure = OnFailure::sweep;
  bool hold_taut = false;        // taut spans of yarns keep strain (held_spans.h)
  double allowance = 1;          // yarns may leave this share of what they usually leave
  double stood_at = 0;           // sweeps, the last time (standstill.h)
  bool predicted = false;        // solved is where the substep would lead without constraints
  kernels::VectorsView start{};  // with scheme rattle: where the directions are
  bool by_rattle() const { return start.x != nullptr; }
};

/// In order of severity. made_do: the solver failed, in one round of contacts at least; the result
/// is that of sweeps or, where no iterations were left for them, what there was by then. gave_up:
/// it failed, and there is no result. lost: the result is not finite.
enum class Ended : std::uint8_t { solved, made_do, gave_up, lost };

/// What an attempt came to; it counts when the attempt is accepted. Work and times go into the
/// report in any case.
struct Trial {
  Ended ended = Ended::solved;
  Status status = Status::converged;
  bool gained = false;                       // energy rose (energy.h)
  double stood_at = 0;                       // what sweeps could not solve; 0: nothing
  std::uint32_t passed_particle = kNoIndex;  // the description's number

  bool has_result() const { return ended <= Ended::made_do; }
  void worsen(Status by) { status = std::max(status, by); }
  void worsen(Ended by) { ended = std::max(ended, by); }
};

/// Moves solved until every constraint is within tolerance.
Trial solve_positions(State& s, const Attempt& attempt, StepReport& report, Team& team);
/// The velocity loop: changes next_velocity.
Status correct_velocities(State& s, const Attempt& attempt, StepReport& report, Team& team);

/// True errors at x.
Strain strain_at(State& s, kernels::Vectors& x, Team& team);
double max_strain_at(State& s, kernels::Vectors& x, Team& team);
double penetration_at(State& s, kernels::Vectors& x);
/// All of them, for the report.
void report_errors(State& s, kernels::Vectors& x, StepReport& report, Team& team);

}  // namespace weft
