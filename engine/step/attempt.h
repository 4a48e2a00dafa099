/// One way to advance a state by h, and what became of it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "engine/step/state.h"

namespace weft {

/// by_solver: a prediction, and the solver of the settings (exact_substep.h). by_stand_in: the same
/// with the direct solver. by_small_steps: small_step.h. by_sweeps: a prediction, and the paper's
/// loop.
enum class Method : std::uint8_t { by_solver, by_stand_in, by_small_steps, by_sweeps };

/// An entry of the ordered list that a substep is tried by (plan.h).
struct Attempt {
  Method method = Method::by_solver;
  Scheme scheme = Scheme::paper;
  int parts = 1;         // equal ones, that the substep is done in
  bool is_last = false;  // nothing is tried after it: its result is accepted with its error
};

/// accepted: solved and next_velocity are the next state. rejected: the next attempt is wanted.
/// not_finite: there is no next state.
enum class Outcome : std::uint8_t { accepted, rejected, not_finite };

/// What one part of an attempt came to.
struct Trial {
  Outcome outcome = Outcome::accepted;
  Status status = Status::converged;
  double pin_work = 0;                       // J
  int substeps = 1;                          // that it took
  std::uint32_t passed_particle = kNoIndex;  // the description's number

  void worsen(Status by) { status = std::max(status, by); }
  void add(const Trial& next) {
    worsen(next.status);
    pin_work += next.pin_work;
    substeps += next.substeps;
    if (next.passed_particle != kNoIndex) passed_particle = next.passed_particle;
  }
};

/// Iterations that one part of an attempt may take.
struct Budget {
  int positions = 1, velocities = 1;
};

}  // namespace weft
