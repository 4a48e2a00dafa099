/// What a step may have to do before it begins, and to say where it is not committed.
#pragma once

#include "engine/step/state.h"

namespace weft {

/// What is out of place where a step begins, because positions were given, pins were put down, or
/// the model has changed.
struct OutOfPlace {
  bool edges = false;    // rigid ones are out of tolerance, or contacts and anchors
  bool springs = false;  // that are fast (fast_springs.h), or triangles of fabric
  bool any() const { return edges || springs; }
};
OutOfPlace find_out_of_place(State& s, Team& team);

/// Moves the positions onto the constraints and leaves the velocities. Springs that are out of
/// place come near the equilibrium among them, as if through honey: several times they have a short
/// while to give way from rest, without gravity and forces. What cannot be put right
/// with half of the iterations that a step may take is left to the step, and to its status. Small
/// steps have half of these behind a solver, which ends at the other half.
void project(State& s, const OutOfPlace& what, double dt, StepReport& report, Team& team);

/// Of a step that is not committed: who left the range of numbers, and whether that would have
/// happened without any constraint.
void explain(State& s, double h, StepReport& report, Team& team);

/// The true errors at x, where a step ends or where it begins. What is left of the laws of springs
/// is told by whoever solved them.
void report_errors(State& s, kernels::Vectors& x, bool ends, StepReport& report, Team& team);

}  // namespace weft
