/// One way to advance a state by a substep or a part of it, and its outcome.
#pragma once

#include <algorithm>
#include <cstdint>

#include "engine/step/state.h"
#include "engine/tuning.h"

namespace weft {

/// by_solver: a prediction, and the solver of the settings (exact_substep.h). by_stand_in: the same
/// with the direct solver. by_small_steps: small_step.h. by_sweeps: a prediction, and the paper's
/// loop.
enum class Method : std::uint8_t { by_solver, by_stand_in, by_small_steps, by_sweeps };

/// Parts of a substep, the shortest that are tried.
inline constexpr int kFinest = 1 << tuning::kMostDoublings;

/// An entry of the ordered list that a substep is tried by (plan.h).
struct Attempt {
  Method method = Method::by_solver;
  Scheme scheme = Scheme::paper;
  int parts = 1;         // it does one of so many of a substep, or what is left
  int doublings = 0;     // of the number of small steps
  bool saves = true;     // half of the iterations are for those after it, if there are any
  bool is_last = false;  // nothing is tried after it: its result is accepted with its error
  bool in_vain = false;  // no state keeps the constraints: it may take little time

  /// In finest parts of the substep, like begin.
  int end_of(int begin) const { return std::min(kFinest, begin + kFinest / parts); }
};

/// accepted: solved and next_velocity are the next state. rejected: the next attempt is wanted.
/// not_finite: there is no next state.
///
/// A part is rejected if its solver gives up or uses up its iterations, if its velocities do not
/// converge (rattle), or if it gains energy (energy.h). Yarns aim at tuning::kYarnGoal: a part
/// that misses that is rejected too, unless it is the shortest. Small steps of fabric are
/// rejected where they are too long for a load that arrives (tuning::kMostLeft) or for the motion
/// tolerance, and then until they converge. Those of rigid lengths are not: where cloth snaps taut
/// the error of motion need not fall.
enum class Outcome : std::uint8_t { accepted, rejected, not_finite };

/// The outcome of an attempt.
struct Trial {
  Outcome outcome = Outcome::accepted;
  Status status = Status::converged;
  double pin_work = 0;                       // J
  double energy_lost = 0;                    // J
  double seam_work = 0;                      // J
  double motion_error = 0;                   // m/s
  double refinement = 0;                     // that the next step is to begin with
  Lengthening lengthening;                   // likewise
  int substeps = 1;                          // that it took
  std::uint32_t passed_particle = kNoIndex;  // the description's number

  void worsen(Status by) { status = std::max(status, by); }
};

/// Iterations that an attempt may take.
struct Budget {
  int positions = 1, velocities = 1;
};

}  // namespace weft
