/// The plan of a frame of small steps: a step, a projection, or a look ahead.
#pragma once

#include "engine/solvers/small_steps/small_steps.h"
#include "engine/step/attempt.h"
#include "engine/step/state.h"

namespace weft {

/// Whether small steps stand in for another solver: they have no past, and no energy in springs.
inline bool takes_over_in(const State& s) { return s.settings.solver != Solver::small_steps; }
/// Whether State::refinement says how much shorter substeps are than is known beforehand.
bool refines_substeps(const State& s);

/// error: of motion, m/s.
bool exceeds_motion_tolerance(const State& s, double error);
/// Whether shorter substeps would make it smaller: it is not of rounding.
bool motion_error_can_fall(const State& s, const FramePlan& plan, double error);

/// Substeps are about as long as the load allows. A step that is far shorter than the load allows
/// is no stiffer. Work in vain is bounded as where a number of substeps was given. This writes over
/// solved and, with free spheres, contacts.
FramePlan plan_of_step(State& s, const Attempt& attempt, double dt, const Budget& budget);
/// From rest; springs up to the compliance `softest` have the time dt_frame to give way, and softer
/// ones are left as they are. goes_on: from where the last projection of this step has ended.
FramePlan plan_of_projection(State& s, double softest, double dt_frame, bool goes_on,
                             const Budget& budget);
/// One substep of dt_frame from rest, of all that acts but bodies.
FramePlan plan_of_look_ahead(const State& s, double dt_frame);

/// s^2, of a sweep: its compliance over w_a + w_b.
double give_per_mass(const State& s, const FramePlan& plan);

/// How a frame went.
struct FrameCourse {
  double motion_error = 0;  // m/s
  double beyond = 0;        // the time that it took besides a sweep for each substep, in sweeps
  double left = 0;  // the error after the last substep, before rounds put it right, in tolerances
};

/// State::refinement after a frame. Only where refines_substeps(s).
double next_refinement(const State& s, const FramePlan& plan, const FrameCourse& course,
                       const Budget& budget, Lengthening& lengthening);

/// The same, at least so much that bending, which was not solved to the tolerance, is softer.
double refinement_for_bending(const State& s, const FramePlan& plan, double refinement,
                              const Budget& budget);

}  // namespace weft
