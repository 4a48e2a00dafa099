#include "engine/step/small_step.h"

#include <algorithm>
#include <cmath>

#include "engine/measure/state_measure.h"
#include "engine/solvers/small_steps/fold_length.h"
#include "engine/solvers/small_steps/free_bodies.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/solvers/stall.h"
#include "engine/solvers/sweeps/sweeps.h"
#include "engine/step/energy.h"
#include "engine/step/exact_substep.h"
#include "engine/step/frame_forces.h"
#include "engine/step/frame_passes.h"
#include "engine/step/frame_places.h"
#include "engine/step/frame_plan.h"
#include "engine/step/frame_spheres.h"
#include "engine/step/motion.h"
#include "engine/step/pin_work.h"
#include "engine/step/report_errors.h"
#include "engine/step/reporting.h"
#include "engine/tuning.h"

namespace weft {
namespace {

/// Where bending takes more steps than a solution may have it leaves more than the tolerance.
bool leaves_bending(const State& s) {
  return s.small_steps->bending_error() > s.settings.tolerance;
}

/// The frame that is being done, by its plan.
class Frame {
 public:
  Frame(State& s, StepReport& report, Team& team)
      : s_(s), solver_(*s.small_steps), report_(report), team_(team) {}
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  void begin(const FramePlan& plan, kernels::VectorsView velocity) {
    plan_ = plan;
    passes_.begin(plan.passes);
    const kernels::VectorsView force =
        s_.forces().size() > 0 ? s_.forces().view() : kernels::VectorsView{};
    s_.nearby.forget();
    s_.contacts.clear();  // of the last frame: a state that was loaded has none
    solver_.begin(s_.position.view(), velocity, s_.gravity, force, plan_, team_);
  }
  void begin_at_rest(const FramePlan& plan) {
    s_.next_velocity = kernels::Vectors(s_.next_velocity.size());
    begin(plan, s_.next_velocity.view());
  }
  /// Begins the motion of a step.
  void begin_motion(const FramePlan& plan) {
    begin(plan, s_.velocity.view());
    forces_.begin();
    give_ = give_per_mass(s_, plan_);
    const double give_before = plan_.placed ? 0 : s_.give_per_mass;
    give_before_ = std::max(give_, give_before);
    strain_energy_before_ = strain_energy(s_.position, give_before_);
    bending_energy_before_ = solver_.bending_energy(0, team_);
    knows_bends_ = goes_on() && turns_folds();
    if (!knows_bends_) held_bending_before_ = solver_.bending_energy(give_before_, team_);
  }
  void substep() {
    forces_.begin_substep(team_);
    solver_.advance(team_);
    const bool to_tolerance = s_.settings.iterations == 0;
    for (int i = 0; i < std::max(1, s_.settings.iterations); ++i) sweep();
    solver_.weigh();
    forces_.end_sweep(team_);
    solver_.take_contact_visits();  // as a sweep for each substep
    const double rest = passes_.left() - passes_.share_of_substep(places_.left());
    places_.end_substep();
    const bool mends = to_tolerance && mends_now();
    if (mends) {
      solver_.judge(team_);
      if (s_.model->has_laws()) law_error_ = solver_.law_error_of_out();
      sweep_while_many_are_out(tuning::kMended, rest);
    }
    spheres_.find_contacts(team_);
    if (mends) {
      repair(rest);
    } else if (to_tolerance && s_.contacts.count() > 0) {
      passes_.count(solver_.repair(s_.contacts, 0, team_));
    }
    solver_.end_seams();
    yielded_ += solver_.yield(give_);
    spheres_.watch_crossings(team_);
  }

  /// Corrects the errors that the last substep left out of tolerance, in rounds of a sweep and
  /// local passes that look at all constraints. If rounds no longer bring the error down it is
  /// there to stay.
  Status finish() {
    constexpr int kMostVerifications = 4;
    places_.read(team_);
    Status status = put_right_what_is_left();
    for (int i = 1; solver_.end_contacts(team_); ++i) {
      places_.read(team_);
      if (is_within_tolerance() || status != Status::converged) break;
      status = Status::iteration_limit;
      if (i == kMostVerifications) break;
      status = put_right_what_is_left();
    }
    passes_.end();
    return status;
  }

  /// Whether a load has arrived for which these substeps are too long: their last sweep has left a
  /// law more than corrections may bring down.
  bool leaves_too_much() const {
    const bool took_long = passes_.taken() > tuning::kLoadedShare * plan_.substeps;
    const double most = took_long ? tuning::kMostLeftUnderLoad : tuning::kMostLeft;
    return plan_.may_be_finer && law_error_ > most * s_.settings.tolerance;
  }
  /// Whether shorter substeps would bring the motion nearer to what is asked, once velocities were
  /// read.
  bool departs_too_much() const {
    const double error = solver_.motion_error();
    return exceeds_motion_tolerance(s_, error) && motion_error_can_fall(s_, plan_, error);
  }
  /// No number of substeps brings such cloth out.
  bool crosses_body() {
    solver_.report_bodies(s_.body_report);
    return s_.body_report.failures.left > 0;
  }

  /// Where a substep from rest leads that nothing is asked of beyond its sweep.
  void look_ahead() {
    solver_.advance(team_);
    sweep();
    places_.read(team_);
  }
  /// From where the particles are, as far as the work of a round brings laws: what is left is for
  /// the next time.
  void give_way() {
    const double rest = std::max(0.0, passes_.left() - passes_.most_of_substep());
    sweep_beyond(0);
    solver_.judge(team_);
    sweep_while_many_are_out(0, rest);
    repair(rest);
    solver_.end_contacts(team_);
    passes_.end();
    places_.read(team_);
  }
  /// From where the particles are, without a substep.
  void put_right_at_once() {
    if (passes_.left() >= 1) sweep_beyond(0);
    finish();
  }

  /// A particle under the surface of a body comes out slowly: no round would bring it out
  /// sooner. Returns whether something is deeper than the tolerance.
  bool is_in_body() {
    const double depth = solver_.deepest_in_body(team_);
    report_.max_penetration = std::max(report_.max_penetration, depth);
    return depth > s_.settings.contact_tolerance;
  }

  void read_velocities() {
    solver_.settle(team_);
    solver_.read_velocities(s_.next_velocity.view(), team_);
  }

  /// Adds what the solver reached to the report.
  bool is_within_tolerance() {
    timed(report_, Stage::report, [&] {
      report_errors(s_, s_.solved, !plan_.projects(), report_, team_);
      const SeamGaps gaps = measure_seams(*s_.model, solver_.seams().states(), s_.solved);
      report_.open_seams = gaps.open;
      report_.max_seam_gap = gaps.largest;
      report_.late_seams = gaps.late;
      report_.worst_seam = gaps.worst_late;
      report_.max_rail_gap = largest_rail_gap(*s_.model, solver_.sliders().places(), s_.solved);
      if (s_.model->has_laws()) {
        const double of_rigid = s_.model->constraints.has_springs() ? 0 : report_.max_error;
        report_.max_error = std::max(of_rigid, solver_.law_error());
      }
    });
    return report_.max_error <= s_.settings.tolerance &&
           report_.max_penetration <= s_.settings.contact_tolerance &&
           report_.max_anchor_error <= s_.settings.contact_tolerance &&
           report_.max_seam_gap <= s_.settings.contact_tolerance &&
           report_.max_rail_gap <= s_.settings.contact_tolerance;
  }

  /// J, by springs and triangles of fabric, since the beginning: there those that have become
  /// stiffer because substeps are shorter had no more than before.
  double released_by_strain() { return strain_energy_before_ - strain_energy(s_.solved, give_); }
  /// J, by which the energy of bending has fallen. It includes the energy that yielding has lost.
  double released_by_bending() { return bending_energy_before_ - solver_.bending_energy(0, team_); }
  /// J of it, that can have become motion, with hinges that have yielded as they are now. It takes
  /// as long as the bending of two substeps.
  double moved_by_bending() {
    if (s_.model->bending.size() == 0) return 0;
    if (!knows_bends_) {
      return held_bending_before_ - solver_.bending_energy(give_, team_) - std::max(0.0, yielded_);
    }
    return solver_.releasable_bending_energy(s_.position.view(), give_before_, team_) -
           solver_.releasable_bending_energy(s_.solved.view(), give_, team_);
  }
  /// See FrameForces::end().
  double end_forces() { return forces_.end(); }
  FrameCourse course() const {
    return {.motion_error = solver_.motion_error(), .beyond = passes_.taken(), .left = left_};
  }
  /// See StepReport. Where a sweep leaves nothing to mend the step leaves what the sweep does.
  double law_error() const { return std::max(law_error_, report_.max_error); }
  std::uint32_t passed_particle() const { return spheres_.passed_particle(); }

 private:
  /// Whether substeps are about as long as in the frame before, if there was one. Where they are
  /// far longer, bends give back what shorter ones have loaded unseen (perf/tried.md).
  bool goes_on() const { return plan_.placed || solver_.has_past(); }
  /// Whether substeps resolve how folds turn, which the matrix of bending does not know.
  bool turns_folds() const {
    return plan_.dt_substep <=
           substep_length_for_folds(*s_.model, solver_.creases().creases(), s_.position.view());
  }
  double strain_energy(kernels::Vectors& x, double give) {
    return s_.measure->spring_energy(x.view(), give, team_) +
           energy_of_membrane(*s_.model, x, give);
  }
  Status put_right_what_is_left() {
    Stall stall(tuning::kRoundPatience);
    for (int round = 0;; ++round) {
      const bool is_within = is_within_tolerance();
      const double error = error_in_tolerances();
      left_ = std::max(left_, error);
      if (is_within) return Status::converged;
      if (s_.settings.iterations > 0) return Status::fixed_iterations;
      if (leaves_too_much() && !crosses_body()) return Status::iteration_limit;
      if (round >= tuning::kMostRounds || passes_.left() < 1) return Status::iteration_limit;
      if (stall.has_stalled(error)) return Status::infeasible;
      put_right();
    }
  }
  /// The largest, as reported.
  double error_in_tolerances() const {
    const double distance = std::max({report_.max_penetration, report_.max_anchor_error,
                                      report_.max_seam_gap, report_.max_rail_gap});
    return std::max(report_.max_error / s_.settings.tolerance,
                    distance / s_.settings.contact_tolerance);
  }
  /// By whole sweeps: where the last substep has left so much, as under what falls into the cloth,
  /// a share of the tolerance would not carry the load to the pins.
  void put_right() {
    sweep_beyond(0);
    const double most = std::min(passes_.left(), passes_.most_of_substep());
    count(solver_.repair_everywhere(s_.contacts, passes_.most_visits(most), team_));
    places_.read(team_);
  }
  /// rest: of the passes that are left, those that are not for this.
  void repair(double rest) {
    const std::int64_t most = passes_.most_visits(passes_.left() - rest);
    count(solver_.repair(s_.contacts, most, team_));
  }
  void count(const LocalWork& work) {
    passes_.count(work);
    passes_.count_contacts(work, solver_.take_contact_visits());
  }
  /// After constraints were judged. rest: as above.
  void sweep_while_many_are_out(double to, double rest) {
    while (passes_.left() - rest >= 1 && passes_.are_many(solver_.count_out())) {
      sweep_beyond(to);
      solver_.judge(team_);
    }
  }
  void sweep_beyond(double to) {
    plan_.projects() ? solver_.sweep(team_) : solver_.mend(to, team_);
    passes_.count_sweep_beyond();
    passes_.count_contacts(solver_.take_contact_visits());
  }
  void sweep() {
    solver_.sweep(team_);
    passes_.count_sweep();
  }
  /// The next sweep has the error that a sweep leaves of a law, and small steps bring it down
  /// faster than local passes do: these wait for the last substep, and before it contacts alone are
  /// corrected. Errors of a rigid length would turn into speed.
  bool mends_now() const { return !s_.model->has_laws() || places_.left() == 0; }

  State& s_;
  SmallSteps& solver_;
  StepReport& report_;
  Team& team_;
  FramePlan plan_;
  FramePlaces places_{s_, plan_};
  FramePasses passes_{*s_.model, s_.contacts, report_};
  FrameForces forces_{s_, plan_, places_};
  FrameSpheres spheres_{s_, places_, report_};
  double left_ = 0;                    // FrameCourse
  double law_error_ = 0;               // a strain, of the last sweep, before it was mended
  double give_ = 0, give_before_ = 0;  // s^2, give_per_mass(); of the beginning
  double strain_energy_before_ = 0, bending_energy_before_ = 0;  // J, in the beginning
  bool knows_bends_ = true;         // else each hinge is held to what a substep resolves of it
  double held_bending_before_ = 0;  // J, of hinges that are held to it, in the beginning
  double yielded_ = 0;              // J, that they have lost because they yielded
};

/// As timed. To find contacts with bodies is a stage of its own.
template <class Work>
void timed_with_contacts(State& s, StepReport& report, Stage stage, Work&& work) {
  timed(report, stage, [&] {
    work();
    const ContactMs ms = s.small_steps->take_contact_ms();
    report.stage_seconds[static_cast<std::size_t>(Stage::find_contacts)] += 1e-3 * ms.find;
    report.contact_ms.find += ms.find;
    report.contact_ms.sweep += ms.sweep;
    report.contact_ms.verify += ms.verify;
  });
}

/// Data that a frame leaves to those after it, besides positions and velocities.
struct Remains {
  double give_per_mass = 0, lost_energy = 0;  // State
};

/// The one place where a frame writes what lasts, but for State::solved and next_velocity, which
/// become the next positions and velocities if the trial is accepted.
void commit(State& s, const Remains& remains, Team& team) {
  s.give_per_mass = remains.give_per_mass;
  s.lost_energy = remains.lost_energy;
  if (s.laws) s.elastic_energy = energy_of_springs(*s.model, s.solved, s.give_per_mass);
  s.seams.take(s.small_steps->seams().states());
  s.sliders.take(s.small_steps->sliders().places());
  s.creases.take(s.small_steps->creases().creases());
  s.bodies.take(s.small_steps->free_bodies().states());
  if (!takes_over_in(s)) s.small_steps->keep(team);  // else the past is not looked at
}

/// The guard of energy, and what there is to tell.
Remains end_frame(State& s, Frame& frame, const FramePlan& plan, double dt_frame,
                  const Budget& budget, kernels::ImpulseEnergy& change, Trial& trial) {
  Remains remains{give_per_mass(s, plan), takes_over_in(s) ? 0 : s.lost_energy};
  trial.seam_work = s.small_steps->seams().work();
  const double released =
      frame.released_by_strain() + trial.seam_work + s.body_report.work + s.body_report.untangling;
  if (s.settings.iterations == 0)
    remains.lost_energy = guard_springs(s, remains.lost_energy, released + frame.moved_by_bending(),
                                        dt_frame, change);
  s.body_report.work += s.small_steps->free_bodies().slowed();
  if (pins_move(s)) trial.pin_work = work_of(motion_of_pins(s, dt_frame), s, dt_frame);
  trial.energy_lost = trial.pin_work + released + frame.released_by_bending() - 0.5 * change.gain;
  if (refines_substeps(s)) {
    trial.lengthening = s.lengthening;
    trial.refinement = next_refinement(s, plan, frame.course(), budget, trial.lengthening);
    if (leaves_bending(s))
      trial.refinement = refinement_for_bending(s, plan, trial.refinement, budget);
  }
  return remains;
}

/// Where a load or a motion has arrived within the frame, substeps are doubled until it converges.
bool is_rejected(const Attempt& attempt, const FramePlan& plan, bool misses, Frame& frame) {
  if (!plan.may_be_finer) return misses && attempt.saves;
  const bool is_again = attempt.doublings > 0;
  const bool is_too_long = frame.leaves_too_much() || frame.departs_too_much();
  return (is_too_long || (is_again && misses)) && !frame.crosses_body();
}

}  // namespace

Trial small_step(State& s, const Attempt& attempt, double dt_frame, const Budget& budget,
                 StepReport& report, Team& team) {
  const bool fixed = s.settings.iterations > 0;
  Trial trial;
  Frame frame(s, report, team);
  FramePlan plan;
  timed_with_contacts(s, report, Stage::predict, [&] {
    plan = plan_of_step(s, attempt, dt_frame, budget);
    frame.begin_motion(plan);
  });
  bool is_in_body = false;
  timed_with_contacts(s, report, Stage::solve_positions, [&] {
    for (int i = 0; i < plan.substeps; ++i) frame.substep();
    trial.status = frame.finish();
    is_in_body = frame.is_in_body();
  });
  trial.substeps = plan.substeps;
  timed(report, Stage::commit, [&] { frame.read_velocities(); });
  const bool misses = trial.status != Status::converged || is_in_body;
  if (is_rejected(attempt, plan, misses, frame)) {
    trial.outcome = Outcome::rejected;
    return trial;
  }
  if (!takes_over_in(s)) trial.motion_error = s.small_steps->motion_error();
  report.max_bending_error = std::max(report.max_bending_error, s.small_steps->bending_error());
  if (s.model->has_laws()) report.law_error = std::max(report.law_error, frame.law_error());
  kernels::ImpulseEnergy change;
  timed(report, Stage::commit, [&] { s.small_steps->report_bodies(s.body_report); });
  if (s.settings.velocity_correction) {
    timed(report, Stage::correct_velocities,
          [&] { trial.worsen(correct_velocities(s, *s.sweeps, false, budget, report, team)); });
  }
  timed(report, Stage::commit, [&] {
    const double work = frame.end_forces();
    change = measure_energy_change(s, team);
    change.gain -= 2 * work;
  });
  // A position is no number only where the velocity is none.
  if (!std::isfinite(change.energy)) {
    trial.outcome = Outcome::not_finite;
    return trial;
  }
  if (fixed)
    trial.worsen(Status::fixed_iterations);
  else if (is_in_body || exceeds_motion_tolerance(s, trial.motion_error) ||
           s.body_report.failures.left > 0 || s.body_report.failures.is_tangled_anew ||
           leaves_bending(s) || report.late_seams > 0)
    trial.worsen(Status::iteration_limit);
  if (frame.passed_particle() != kNoIndex) {
    trial.passed_particle = frame.passed_particle();
    trial.worsen(Status::passed_through);
  }
  timed(report, Stage::commit,
        [&] { commit(s, end_frame(s, frame, plan, dt_frame, budget, change, trial), team); });
  return trial;
}

void project_by_small_steps(State& s, double softest, double dt_frame, bool goes_on,
                            const Budget& budget, StepReport& report, Team& team) {
  timed_with_contacts(s, report, Stage::solve_positions, [&] {
    Frame frame(s, report, team);
    frame.begin_at_rest(plan_of_projection(s, softest, dt_frame, goes_on, budget));
    if (softest > 0)
      frame.give_way();
    else
      frame.put_right_at_once();
  });
}

void look_ahead_by_small_steps(State& s, double dt_frame, StepReport& report, Team& team) {
  Frame frame(s, report, team);
  frame.begin_at_rest(plan_of_look_ahead(s, dt_frame));
  frame.look_ahead();
}

}  // namespace weft
