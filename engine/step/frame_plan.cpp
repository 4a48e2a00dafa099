#include "engine/step/frame_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/model/rest_lengths.h"
#include "engine/solvers/small_steps/fold_length.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/solvers/small_steps/small_steps_load.h"
#include "engine/step/burden.h"
#include "engine/step/pressure.h"
#include "engine/step/tearing.h"
#include "engine/tuning.h"

namespace weft {
namespace {

/// A substep is a sweep or two, and local passes that may always visit every constraint once.
int most_substeps(const Budget& budget) {
  return std::min(tuning::kMostSubsteps, std::max(1, budget.positions / 3));
}

/// s, of substeps that hold the motion tolerance where the acceleration a sets in and ends again
/// within dt: the departures of a frame are then 2 a h together, or by first order a h each.
double length_for_onset(const State& s, double a, double dt) {
  const double share = SubstepFormula::of(s.settings.scheme, 1).error_share;
  const double length = s.settings.motion_tolerance / (share * a);
  return s.settings.scheme == Scheme::bdf2 ? std::sqrt(0.5 * length * dt) : length;
}

/// s, of substeps that follow the waves that the wind makes.
double length_for_air(const State& s) {
  return s.air_turning > 0 ? tuning::kAirTurn / s.air_turning : tuning::kLongestSubstep;
}

/// s, of the longest substep that the strain tolerance, the motion tolerance and the air allow.
/// The needs of a frame are not known: State::refinement has those of the last ones. Where that is
/// below 0 the cloth pulls less than at the bottom of a swing.
double usual_length(State& s, double dt) {
  Burden burden = burden_of(s, dt);
  burden.weights *= std::exp2(2 * std::min(0.0, s.refinement));
  const double of_load =
      substep_length(s.model->small_steps().load, s.position.view(), burden, s.settings.tolerance);
  const double of_pressure = presses(s) ? length_for_pressure(s) : tuning::kLongestSubstep;
  const double of_tears =
      s.model->may_tear ? substep_length_for_strengths(s) : tuning::kLongestSubstep;
  const double length =
      std::min({tuning::kLongestSubstep, length_for_air(s), of_load, of_pressure, of_tears,
                substep_length_for_folds(*s.model, s.creases.all(), s.position.view())});
  if (!refines_substeps(s)) return length;
  const double shorter = std::exp2(-std::max(0.0, s.refinement));
  if (s.settings.motion_tolerance == 0) return length * shorter;
  return std::min(length, length_for_onset(s, burden.acceleration, dt)) * shorter;
}

/// A sweep is a spring of stiffness omega / (b h)^2, and what it leaves out of shape is its load. A
/// spring that becomes stiffer under load gains energy. So where the caller's frames say how long
/// substeps are, the stiffness rises by no more than e^(dt / kSpringTime) in one.
void keep_stiffness(const State& s, double dt, FramePlan& plan) {
  if (plan.placed) return;
  const double least = s.give_per_mass * std::exp(-dt / tuning::kSpringTime);
  const double give = give_per_mass(s, plan);
  if (give < least) plan.omega *= give / least;
}

/// s, of substeps whose sweeps are as stiff as those of the last frame.
double length_of_last(const State& s) {
  const double part = SubstepFormula::of(s.settings.scheme, 1).part;
  return std::sqrt(tuning::kOmega * s.give_per_mass) / part;
}

/// If a pin was fixed, released or teleported, the cloth at it need not pull: fabric that lies on a
/// table does not. So substeps are no shorter than in the last frame, until a frame has much to
/// correct.
void keep_length(State& s, double dt) {
  const bool is_by_laws = refines_substeps(s) && s.settings.motion_tolerance == 0;
  if (!is_by_laws || !s.displaced || s.placed) return;
  const double shorter = std::log2(std::min(dt, length_of_last(s)) / usual_length(s, dt));
  if (shorter > 0) s.refinement -= shorter;
}

/// s, of the shortest substeps of a frame. Strains that longer ones left would come back as speed.
/// So automatic substeps become shorter over some frames.
double shortest_length(const State& s, double dt) {
  return length_of_last(s) * std::exp(-dt / (2 * tuning::kStiffening));
}

/// A number of substeps that was given bounds the time of a step: where it is less than automatic
/// substeps would be, by the time of those.
double passes_beyond(int substeps, double automatic_substeps) {
  const double missing =
      std::min<double>(automatic_substeps, tuning::kMostSubsteps) - static_cast<double>(substeps);
  return std::max(tuning::kPassesBeyond * substeps, missing);
}

/// Whether an attempt with twice as many can follow one that is rejected.
bool can_be_finer(int substeps, const Budget& budget) {
  return 2 * substeps <= most_substeps({.positions = budget.positions - substeps});
}

/// Particles that are spheres touch closed forms alone.
Gaps gaps_of(State& s) {
  if (!s.bodies.ask_for_gaps() || s.model->has_spheres()) return {};
  if (!s.gaps) s.gaps = widest_gaps(*s.model);
  return *s.gaps;
}

void add_bodies(State& s, FramePlan& plan) {
  plan.bodies = s.bodies.travelling(s.model->friction, gaps_of(s));
  plan.free = s.bodies.free(s.model->friction);
  plan.bodies_move = s.bodies.moving();
  plan.bodies_are_new = s.bodies.are_others();
}

/// The logarithm to base 2 of how many times shorter substeps are to be than is known beforehand.
/// Seldom changed, in levels of a half: by BDF2 one halves the error.
double refinement_for_motion(const State& s, const FramePlan& plan, double error,
                             const Budget& budget) {
  constexpr double kLevel = 0.5;
  const double asked = s.settings.motion_tolerance;
  const bool can_fall = plan.refinement >= s.refinement && plan.substeps < most_substeps(budget) &&
                        motion_error_can_fall(s, plan, error);
  if (error > asked && can_fall) return plan.refinement + kLevel;
  const bool is_small = error < tuning::kMotionSpare * asked;
  const double reached = std::max(s.refinement, plan.refinement);
  return is_small ? std::max(0.0, reached - kLevel) : reached;
}

/// The same for fabric without a motion tolerance. Its load may come from any side, and what
/// carries it sideways is swept one by one: substeps are shorter where a frame left much to put
/// right, and longer where it left little, down to those of cloth that hangs at rest.
double refinement_for_laws(const State& s, const FramePlan& plan, const FrameCourse& course,
                           const Budget& budget, Lengthening& lengthening) {
  constexpr double kLevel = 0.25;
  const double share = course.beyond / plan.substeps;
  if (share > tuning::kMuchMended && plan.substeps < most_substeps(budget)) {
    lengthening.revoke();
    return std::max(s.refinement, plan.refinement + std::log2(1 + share));
  }
  const double least = -std::log2(kWeightsOfSwing) / 2;
  if (plan.refinement < s.refinement || share >= tuning::kLittleMended || plan.refinement <= least)
    return std::max(s.refinement, plan.refinement);
  if (!lengthening.begin(kLevel, course.left)) return plan.refinement;
  return std::max(least, plan.refinement - kLevel);
}

}  // namespace

bool exceeds_motion_tolerance(const State& s, double error) {
  return s.settings.motion_tolerance > 0 && error > s.settings.motion_tolerance;
}

bool motion_error_can_fall(const State& s, const FramePlan& plan, double error) {
  return error > tuning::kOverRounding * s.small_steps->rounding_error(plan.dt_substep);
}

bool refines_substeps(const State& s) {
  if (s.settings.motion_tolerance > 0) return true;
  return s.model->has_laws() && !takes_over_in(s) && s.settings.substeps == kAutomaticSubsteps;
}

double give_per_mass(const State& s, const FramePlan& plan) {
  const double bh = SubstepFormula::of(s.settings.scheme, 1).part * plan.dt_substep;
  return bh * bh / plan.omega;
}

FramePlan plan_of_step(State& s, const Attempt& attempt, double dt, const Budget& budget) {
  const bool takes_over = takes_over_in(s);
  FramePlan plan{.dt_substep = dt,
                 .omega = tuning::kOmega,
                 .placed = s.placed || takes_over,
                 .anchors = s.anchors.travel(),
                 .seams = s.seams.states(),
                 .sliders = s.sliders.places(),
                 .creases = s.creases.all()};
  add_bodies(s, plan);
  keep_length(s, dt);
  plan.refinement = s.refinement;
  const double usual = usual_length(s, dt);
  const double wanted = std::max(1.0, std::ceil(dt / usual));
  if (s.settings.substeps != kAutomaticSubsteps && !takes_over) {
    plan.substeps = s.settings.substeps;
    plan.dt_substep = dt / plan.substeps;
    plan.passes = std::min<double>(budget.positions, passes_beyond(plan.substeps, wanted));
    keep_stiffness(s, dt, plan);
  } else {
    const double begun = plan.placed ? usual : std::max(usual, shortest_length(s, dt));
    const double length = begun / std::exp2(attempt.doublings);
    plan.refinement -= std::log2(length / usual);
    plan.substeps =
        static_cast<int>(std::clamp<double>(std::ceil(dt / length), 1, most_substeps(budget)));
    plan.dt_substep = dt / plan.substeps;
    plan.passes = budget.positions - plan.substeps;
    const double part = 2 * plan.dt_substep / length;
    if (part < 1) plan.omega *= part * part;
  }
  plan.may_be_finer = !attempt.is_last && !takes_over && can_be_finer(plan.substeps, budget);
  if (attempt.in_vain)
    plan.passes = std::min<double>(plan.passes, tuning::kPassesBeyond * plan.substeps);
  return plan;
}

FramePlan plan_of_projection(State& s, double softest, double dt_frame, bool goes_on,
                             const Budget& budget) {
  FramePlan plan{.dt_substep = dt_frame,
                 .passes = static_cast<double>(budget.positions),
                 .omega = tuning::kOmega,
                 .placed = true,
                 .softest = softest,
                 .anchors = s.anchors.standing(),
                 .seams = s.seams.states(),
                 .sliders = s.sliders.places(),
                 .creases = s.creases.all(),
                 .goes_on = goes_on};
  add_bodies(s, plan);
  return plan;
}

FramePlan plan_of_look_ahead(const State& s, double dt_frame) {
  return {.dt_substep = dt_frame,
          .omega = tuning::kOmega,
          .placed = true,
          .softest = std::numeric_limits<double>::infinity(),
          .anchors = s.anchors.standing(),
          .seams = s.seams.states(),
          .sliders = s.sliders.places(),
          .creases = s.creases.all()};
}

double next_refinement(const State& s, const FramePlan& plan, const FrameCourse& course,
                       const Budget& budget, Lengthening& lengthening) {
  if (s.settings.motion_tolerance > 0)
    return refinement_for_motion(s, plan, course.motion_error, budget);
  return refinement_for_laws(s, plan, course, budget, lengthening);
}

double refinement_for_bending(const State& s, const FramePlan& plan, double refinement,
                              const Budget& budget) {
  if (plan.substeps >= most_substeps(budget)) return refinement;
  return std::max(refinement, s.refinement + 1);
}

}  // namespace weft
