#include "engine/step/small_step.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/measure/state_measure.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/solvers/small_steps/small_steps_load.h"
#include "engine/solvers/stall.h"
#include "engine/solvers/sweeps/sweeps.h"
#include "engine/spheres/passages.h"
#include "engine/spheres/sphere_contacts.h"
#include "engine/step/air.h"
#include "engine/step/burden.h"
#include "engine/step/energy.h"
#include "engine/step/exact_substep.h"
#include "engine/step/motion.h"
#include "engine/step/pin_work.h"
#include "engine/step/project.h"
#include "engine/step/reporting.h"
#include "engine/tuning.h"

namespace weft {
namespace {

bool takes_over_in(const State& s) { return s.settings.solver != Solver::small_steps; }

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

/// s, of the longest substep that the strain tolerance and the motion tolerance allow. What a frame
/// will be like is not known: State::refinement says what the last ones were. Where that is below 0
/// the cloth pulls less than at the bottom of a swing.
double usual_length(State& s, double dt) {
  Burden burden = burden_of(s, dt);
  burden.weights *= std::exp2(2 * std::min(0.0, s.refinement));
  const double length = std::min(
      tuning::kLongestSubstep,
      substep_length(s.model->small_steps().load, s.position.view(), burden, s.settings.tolerance));
  if (!refines_substeps(s)) return length;
  const double shorter = std::exp2(-std::max(0.0, s.refinement));
  if (s.settings.motion_tolerance == 0) return length * shorter;
  return std::min(length, length_for_onset(s, burden.acceleration, dt)) * shorter;
}

/// The compliance of a sweep, over w_a + w_b.
double give_per_mass(const State& s, const FramePlan& plan) {
  const double bh = SubstepFormula::of(s.settings.scheme, 1).part * plan.h;
  return bh * bh / plan.omega;
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

/// A number of substeps that was given bounds the time of a step: where it is less than automatic
/// substeps would be, by the time of those.
double passes_beyond(int substeps, double automatic_substeps) {
  const double missing =
      std::min<double>(automatic_substeps, tuning::kMostSubsteps) - static_cast<double>(substeps);
  return std::max(tuning::kPassesBeyond * substeps, missing);
}

/// Substeps are about as long as the load allows. Whoever takes over from another solver has no
/// past, and no energy in springs. A step that is far shorter than the load allows is no stiffer.
/// What is done in vain is bounded as where a number of substeps was given.
FramePlan plan_for(State& s, const Attempt& attempt, double dt, const Budget& budget) {
  const bool takes_over = takes_over_in(s);
  FramePlan plan{.h = dt, .omega = tuning::kOmega, .placed = s.placed || takes_over};
  const double usual = usual_length(s, dt);
  const double wanted = std::max(1.0, std::ceil(dt / usual));
  if (s.settings.substeps != kAutomaticSubsteps && !takes_over) {
    plan.substeps = s.settings.substeps;
    plan.h = dt / plan.substeps;
    plan.passes = std::min<double>(budget.positions, passes_beyond(plan.substeps, wanted));
    keep_stiffness(s, dt, plan);
  } else {
    plan.substeps = static_cast<int>(std::min<double>(wanted, most_substeps(budget)));
    plan.h = dt / plan.substeps;
    plan.passes = budget.positions - plan.substeps;
    const double part = 2 * plan.h / usual;
    if (part < 1) plan.omega *= part * part;
  }
  if (attempt.in_vain)
    plan.passes = std::min<double>(plan.passes, tuning::kPassesBeyond * plan.substeps);
  return plan;
}

/// The logarithm to base 2 of how many times shorter substeps are to be than is known beforehand.
/// Seldom changed, in levels of a half: by BDF2 one halves the error.
double next_refinement(const State& s, const FramePlan& plan, double error, const Budget& budget) {
  constexpr double kLevel = 0.5;
  const double asked = s.settings.motion_tolerance;
  const bool can_fall = plan.substeps < most_substeps(budget) &&
                        error > tuning::kOverRounding * s.small_steps->rounding_error(plan.h);
  if (error > asked && can_fall) return s.refinement + kLevel;
  const bool is_small = error < tuning::kMotionSpare * asked;
  return is_small ? std::max(0.0, s.refinement - kLevel) : s.refinement;
}

/// The same for fabric without a motion tolerance. Its load may come from any side, and what
/// carries it sideways is swept one by one: substeps are shorter where a frame left much to put
/// right, which took the time of `beyond` sweeps, and longer where it left little, down to those of
/// cloth that hangs at rest.
double refinement_for_laws(const State& s, const FramePlan& plan, double beyond,
                           const Budget& budget) {
  constexpr double kLevel = 0.25;
  const double share = beyond / plan.substeps;
  if (share > tuning::kMuchMended && plan.substeps < most_substeps(budget))
    return s.refinement + std::log2(1 + share);
  const double least = -std::log2(kWeightsOfSwing) / 2;
  return share < tuning::kLittleMended ? std::max(least, s.refinement - kLevel) : s.refinement;
}

/// Of local passes over everything, in visits of a sweep that take as long.
double time_of_local_visit(const Model& model) {
  const auto triangles = static_cast<double>(model.membrane.size());
  const auto others = static_cast<double>(model.constraints.size() + model.seams.size());
  if (triangles == 0) return tuning::kLocalVisit;
  const double time = tuning::kLocalVisitOfTriangle * triangles + tuning::kLocalVisit * others;
  return time / (triangles + others);
}

/// The frame that is being done.
class Frame {
 public:
  Frame(State& s, StepReport& report, Team& team)
      : s_(s),
        solver_(*s.small_steps),
        report_(report),
        team_(team),
        edges_(static_cast<std::int64_t>(s.model->constraints.size() + s.model->membrane.size() +
                                         s.model->seams.size())),
        local_visit_(time_of_local_visit(*s.model)) {}

  void begin(const FramePlan& plan) {
    plan_ = plan;
    passes_left_ = plan.passes;
    if (s_.model->has_air() && s_.air_parts > 1) begin_air();
    plan_.anchors = plan.projects ? s_.anchors.standing() : s_.anchors.travel();
    plan_.seams = s_.seams.states();
    if (plan.meets_bodies) plan_.bodies = s_.bodies.travelling(s_.model->friction);
    plan_.bodies_move = s_.bodies.moving();
    plan_.bodies_are_new = s_.bodies.are_others();
    kernels::Vectors& velocity = plan.projects ? s_.next_velocity : s_.velocity;
    if (plan.projects) velocity = kernels::Vectors(velocity.size());  // at rest
    const kernels::VectorsView force =
        s_.forces().size() > 0 ? s_.forces().view() : kernels::VectorsView{};
    s_.nearby.forget();
    solver_.begin(s_.position.view(), velocity.view(), s_.gravity, force, plan_, team_);
    give_ = give_per_mass(s_, plan_);
    const double give_before = plan_.placed ? 0 : s_.give_per_mass;
    elastic_energy_before_ = elastic_energy(s_.position, std::max(give_, give_before));
  }
  /// J, by springs, triangles of fabric and bending elements, since the beginning: there those that
  /// have become stiffer because substeps are shorter had no more than before.
  double released() { return elastic_energy_before_ - elastic_energy(s_.solved, give_); }
  /// Where the air was looked at more than once State::total_force becomes its mean of the frame.
  /// Returns J, by which the work that was done differs from that of the mean.
  double end_air() {
    if (air_begun_ == 0) return 0;
    end_air_part();
    for (std::size_t slot = 0; slot < s_.model->slots(); ++slot) {
      if (s_.model->inverse_mass[slot] == 0) continue;
      const kernels::Vector mean = (1 / (plan_.h * plan_.substeps)) * s_.air_impulse[slot];
      air_work_ -= dot(mean, s_.solved[slot] - s_.position[slot]);
      s_.total_force.set(slot, mean);
    }
    return air_work_;
  }
  /// What the frame took beyond a sweep for each substep, in the time of sweeps.
  double beyond() const { return mended_; }

  void substep() {
    if (air_is_due()) look_at_air();
    solver_.advance(team_);
    const bool to_tolerance = s_.settings.iterations == 0;
    for (int i = 0; i < std::max(1, s_.settings.iterations); ++i) sweep();
    const double rest = passes_left_ - share_of_substep();  // is for later substeps
    ++substeps_done_;
    const bool mends = to_tolerance && mends_now();
    if (mends) sweep_until_few_are_out(tuning::kMended, rest);
    if (s_.model->has_spheres()) timed(report_, Stage::find_contacts, [&] { find_contacts(); });
    if (mends) {
      count(solver_.repair(s_.contacts, most_visits(passes_left_ - rest), team_));
    } else if (to_tolerance && s_.contacts.count() > 0) {
      count(solver_.repair(s_.contacts, 0, team_));
    }
    solver_.end_seams();
    if (s_.model->has_spheres()) timed(report_, Stage::find_contacts, [&] { watch_crossings(); });
  }

  /// Puts right what the last substep left out of tolerance, in rounds of a sweep and local passes
  /// that look at all constraints. If rounds no longer bring the error down it is there to stay.
  Status finish() {
    constexpr int kMostVerifications = 4;
    read_positions();
    Status status = put_right_what_is_left();
    for (int i = 1; solver_.end_contacts(team_); ++i) {
      read_positions();
      if (is_within_tolerance() || status != Status::converged) break;
      status = Status::iteration_limit;
      if (i == kMostVerifications) break;
      status = put_right_what_is_left();
    }
    count_local_passes();
    return status;
  }

  /// Where a substep from rest leads that nothing is asked of beyond its sweep.
  void look_ahead() {
    solver_.advance(team_);
    sweep();
    read_positions();
  }
  /// From where the particles are, as far as the work of a round brings laws: what is left is for
  /// the next time.
  void give_way() {
    const double rest = std::max(0.0, passes_left_ - most_of_substep());
    sweep_beyond(0);
    sweep_until_few_are_out(0, rest);
    count(solver_.repair(s_.contacts, most_visits(passes_left_ - rest), team_));
    count_local_passes();
    read_positions();
  }
  /// From where the particles are, without a substep.
  void put_right_at_once() {
    if (passes_left_ >= 1) sweep_beyond(0);
    finish();
  }

  /// What is under the surface of a body comes out by and by: no round would bring it out sooner.
  /// Returns whether something is deeper than the tolerance.
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
      report_errors(s_, s_.solved, !plan_.projects, report_, team_);
      const SeamGaps gaps = measure_seams(*s_.model, solver_.seams().states(), s_.solved);
      report_.open_seams = gaps.open;
      report_.max_seam_gap = gaps.largest;
      if (s_.model->has_laws()) {
        const double of_rigid = s_.model->constraints.has_springs() ? 0 : report_.max_error;
        report_.max_error = std::max(of_rigid, solver_.law_error());
      }
    });
    return report_.max_error <= s_.settings.tolerance &&
           report_.max_penetration <= s_.settings.contact_tolerance &&
           report_.max_anchor_error <= s_.settings.contact_tolerance &&
           report_.max_seam_gap <= s_.settings.contact_tolerance;
  }

  std::uint32_t passed_particle = kNoIndex;  // the description's number

 private:
  void begin_air() {
    air_every_ = std::max(1, static_cast<int>(plan_.substeps / s_.air_parts));
    s_.air_from = s_.position;
    for (std::size_t slot = 0; slot < s_.model->slots(); ++slot)
      s_.air_impulse.set(slot, {0, 0, 0});
  }
  /// Of forces that were held since the air was looked at.
  void end_air_part() {
    const double h = plan_.h * (substeps_done_ - air_begun_);
    for (std::size_t slot = 0; slot < s_.model->slots(); ++slot) {
      if (s_.model->inverse_mass[slot] == 0) continue;
      const kernels::Vector force = s_.total_force[slot];
      air_work_ += dot(force, s_.solved[slot] - s_.air_from[slot]);
      s_.air_impulse.view().add(slot, h * force);
    }
    air_begun_ = substeps_done_;
  }
  bool air_is_due() const { return air_every_ > 0 && substeps_done_ - air_begun_ == air_every_; }
  void look_at_air() {
    read_positions();
    end_air_part();
    s_.air_from = s_.solved;
    solver_.settle(team_);
    solver_.read_velocities(s_.next_velocity.view(), team_);
    const double h = plan_.h * std::min(air_every_, plan_.substeps - substeps_done_);
    find_resistance(s_, s_.solved.view(), s_.next_velocity.view(), 0, h, team_);
    solver_.accelerate(s_.gravity, s_.total_force.view());
  }
  double elastic_energy(kernels::Vectors& x, double give) {
    return s_.measure->spring_energy(x.view(), give, team_) +
           energy_of_membrane(*s_.model, x, give) + solver_.bending_energy(give, team_);
  }
  Status put_right_what_is_left() {
    Stall stall(tuning::kRoundPatience);
    for (int round = 0;; ++round) {
      if (is_within_tolerance()) return Status::converged;
      if (s_.settings.iterations > 0) return Status::fixed_iterations;
      if (round >= tuning::kMostRounds || passes_left_ < 1) return Status::iteration_limit;
      const double distance =
          std::max({report_.max_penetration, report_.max_anchor_error, report_.max_seam_gap});
      const double error = std::max(report_.max_error / s_.settings.tolerance,
                                    distance / s_.settings.contact_tolerance);
      if (stall.has_stalled(error)) return Status::infeasible;
      put_right();
    }
  }
  /// Of the passes that are left for each substep to come, and for what the last one leaves.
  double share_of_substep() const {
    const double share = passes_left_ / (plan_.substeps - substeps_done_ + 1);
    return std::clamp(share, 0.0, most_of_substep());
  }
  /// By whole sweeps: where the last substep has left so much, as under what falls into the cloth,
  /// a share of the tolerance would not carry the load to the pins.
  void put_right() {
    sweep_beyond(0);
    const double most = std::min(passes_left_, most_of_substep());
    count(solver_.repair_everywhere(s_.contacts, most_visits(most), team_));
    read_positions();
  }
  /// After a sweep. rest: of passes_left_, what is not for this.
  void sweep_until_few_are_out(double to, double rest) {
    solver_.judge(team_);
    while (passes_left_ - rest >= 1 && many_are_out()) {
      sweep_beyond(to);
      solver_.judge(team_);
    }
  }
  void sweep_beyond(double to) {
    plan_.projects ? solver_.sweep(team_) : solver_.mend(to, team_);
    count_sweep();
    passes_left_ -= 1;
    mended_ += 1;
  }
  void sweep() {
    solver_.sweep(team_);
    count_sweep();
  }
  void count_sweep() {
    ++report_.iterations;
    ++report_.direction_updates;
    report_.visits += edges_;
    report_.corrections += edges_;
  }
  /// What a sweep leaves of a law the next one has again, and small steps bring it down faster than
  /// local passes do: these wait for the last substep, and before it contacts alone are put right.
  /// What is left of a rigid length would be let go as speed.
  bool mends_now() const { return !s_.model->has_laws() || substeps_done_ == plan_.substeps; }
  bool many_are_out() const {
    return static_cast<double>(solver_.count_out()) >
           tuning::kManyOut * static_cast<double>(edges_);
  }

  /// Passes visit contacts too, which may be many more than the constraints.
  double visits_of_a_pass() const {
    return std::max(1.0, static_cast<double>(edges_ + s_.contacts.count()));
  }
  std::int64_t most_visits(double passes) const {
    const double most = passes * visits_of_a_pass() / local_visit_;
    return static_cast<std::int64_t>(std::max(0.0, most));
  }
  void count(const LocalWork& work) {
    report_.visits += work.visits;
    report_.corrections += work.corrections;
    const double beyond = static_cast<double>(work.visits - s_.contacts.count());
    const double passes = std::max(0.0, beyond) / visits_of_a_pass();
    local_passes_ += passes;
    passes_left_ -= local_visit_ * passes;
    mended_ += tuning::kLocalVisit * passes;
  }
  void count_local_passes() {
    report_.iterations += static_cast<std::int64_t>(std::ceil(local_passes_));
  }
  void read_positions() {
    s_.solved = s_.position;
    solver_.read_positions(s_.solved.view(), team_);
    place_pins();
    place_attached();
  }
  /// Exactly where they travel to: lanes round their way.
  void place_pins() {
    if (!s_.pins.moving()) return;
    const double time = plan_.h * substeps_done_;
    for (const std::uint32_t pin : s_.model->pins) {
      s_.solved.set(pin, s_.position[pin] + time * s_.velocity[pin]);
    }
  }
  /// Where the points of their anchors are.
  void place_attached() {
    const AnchorStore& anchors = s_.model->anchors;
    const double share = static_cast<double>(substeps_done_) / plan_.substeps;
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      if (anchors.limits[i].most > 0) continue;
      const kernels::Vector from = plan_.anchors.from[i].point, to = plan_.anchors.to[i].point;
      s_.solved.set(anchors.slot[i],
                    substeps_done_ == plan_.substeps ? to : from + share * (to - from));
    }
  }
  /// Pairs that may touch are found anew when something may have come from beyond them.
  void find_contacts() {
    const double way = solver_.largest_move(team_);
    if (!s_.nearby.hold_after(way)) {
      read_positions();
      s_.nearby.find(*s_.model, *s_.kernels, s_.solved.view(), margin_for(way), s_.contacts);
    } else if (!s_.nearby.slots().empty()) {
      solver_.read_positions_of(s_.nearby.slots(), s_.solved.view());
      place_pins();
      place_attached();
    }
    s_.nearby.list_contacts(*s_.model, s_.solved.view(), s_.contacts);
  }
  /// m, for the substeps to come, if they go on as this one. Wider margins hold more pairs.
  double margin_for(double way) const {
    double radius = 0;
    for (const std::uint32_t sphere : s_.model->spheres)
      radius = std::max(radius, s_.model->radius[sphere]);
    const double left = plan_.substeps - substeps_done_ + 1;
    return std::min(tuning::kNearbySpare * way * left, tuning::kNearbyMost * radius);
  }
  void watch_crossings() {
    const double way = solver_.largest_move(team_);
    s_.nearby.move(way);
    if (!may_have_passed(*s_.model, way)) return;
    solver_.read_starts(s_.substep_positions.view(), team_);
    read_positions();
    const std::uint32_t passed = find_passage(*s_.model, *s_.kernels, s_.substep_positions.view(),
                                              s_.solved.view(), s_.contacts);
    if (passed != kNoIndex) passed_particle = s_.model->ordering.particle_at[passed];
  }

  double most_of_substep() const { return local_visit_ * tuning::kMostVisits; }

  State& s_;
  SmallSteps& solver_;
  StepReport& report_;
  Team& team_;

  double passes_left_ = 0;    // beyond a sweep for each substep, in the time of sweeps
  double local_passes_ = 0;   // done
  const std::int64_t edges_;  // all constraints, triangles of fabric and seams
  FramePlan plan_;
  const double local_visit_;  // in visits of a sweep
  int substeps_done_ = 0;
  int air_every_ = 0;    // substeps; 0: the air was looked at when the frame began
  int air_begun_ = 0;    // of the present part, in substeps
  double air_work_ = 0;  // J
  double mended_ = 0;    // beyond a sweep for each substep, any local visit as kLocalVisit
  double give_ = 0;      // s^2, of a sweep, per mass
  double elastic_energy_before_ = 0;  // J, in the beginning
};

/// As timed. To find contacts with bodies is a stage of its own.
template <class Work>
void timed_with_contacts(State& s, StepReport& report, Stage stage, Work&& work) {
  timed(report, stage, [&] {
    work();
    const ContactMs ms = s.small_steps->contact_times.take();
    report.stage_seconds[static_cast<std::size_t>(Stage::find_contacts)] += 1e-3 * ms.find;
    report.contact_ms.find += ms.find;
    report.contact_ms.sweep += ms.sweep;
    report.contact_ms.verify += ms.verify;
  });
}

}  // namespace

bool refines_substeps(const State& s) {
  if (s.settings.motion_tolerance > 0) return true;
  return s.model->has_laws() && !takes_over_in(s) && s.settings.substeps == kAutomaticSubsteps;
}

Trial small_step(State& s, const Attempt& attempt, double h, const Budget& budget,
                 StepReport& report, Team& team) {
  const bool fixed = s.settings.iterations > 0;
  Trial trial;
  Frame frame(s, report, team);
  FramePlan plan;
  timed_with_contacts(s, report, Stage::predict, [&] {
    plan = plan_for(s, attempt, h, budget);
    frame.begin(plan);
  });
  bool is_in_body = false;
  timed_with_contacts(s, report, Stage::solve_positions, [&] {
    for (int i = 0; i < plan.substeps; ++i) frame.substep();
    trial.status = frame.finish();
    is_in_body = frame.is_in_body();
  });
  trial.substeps = plan.substeps;
  if (trial.status != Status::converged && !attempt.is_last) {
    trial.outcome = Outcome::rejected;
    return trial;
  }
  kernels::ImpulseEnergy change;
  timed(report, Stage::commit, [&] {
    frame.read_velocities();
    s.small_steps->report_bodies(s.body_report);
  });
  if (s.settings.velocity_correction) {
    timed(report, Stage::correct_velocities,
          [&] { trial.worsen(correct_velocities(s, *s.sweeps, false, budget, report, team)); });
  }
  timed(report, Stage::commit, [&] {
    const double work = frame.end_air();
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
  else if (is_in_body || s.body_report.failures.left > 0)
    trial.worsen(Status::iteration_limit);
  if (frame.passed_particle != kNoIndex) {
    trial.passed_particle = frame.passed_particle;
    trial.worsen(Status::passed_through);
  }
  timed(report, Stage::commit, [&] {
    if (takes_over_in(s)) s.lost_energy = 0;
    s.give_per_mass = give_per_mass(s, plan);
    if (s.laws) s.elastic_energy = energy_of_springs(*s.model, s.solved, s.give_per_mass);
    s.seams.take(s.small_steps->seams().states());
    trial.seam_work = s.small_steps->seams().work();
    const double released = frame.released() + trial.seam_work + s.body_report.work;
    if (!fixed) guard_springs(s, change, released, h);
    if (pins_move(s)) trial.pin_work = work_of(motion_of_pins(s, h), s, h);
    trial.energy_lost = trial.pin_work + released - 0.5 * change.gain;
    if (!takes_over_in(s)) trial.motion_error = s.small_steps->motion_error();
    if (s.settings.motion_tolerance > 0)
      trial.refinement = next_refinement(s, plan, trial.motion_error, budget);
    else if (refines_substeps(s))
      trial.refinement = refinement_for_laws(s, plan, frame.beyond(), budget);
    if (!takes_over_in(s)) s.small_steps->keep(team);  // else the past is not looked at
  });
  return trial;
}

void project_by_small_steps(State& s, double softest, double h, const Budget& budget,
                            StepReport& report, Team& team) {
  timed_with_contacts(s, report, Stage::solve_positions, [&] {
    Frame frame(s, report, team);
    frame.begin({.h = h,
                 .passes = static_cast<double>(budget.positions),
                 .omega = tuning::kOmega,
                 .placed = true,
                 .projects = true,
                 .softest = softest});
    if (softest > 0)
      frame.give_way();
    else
      frame.put_right_at_once();
  });
}

void look_ahead_by_small_steps(State& s, double h, StepReport& report, Team& team) {
  Frame frame(s, report, team);
  frame.begin({.h = h,
               .omega = tuning::kOmega,
               .placed = true,
               .projects = true,
               .softest = std::numeric_limits<double>::infinity(),
               .meets_bodies = false});
  frame.look_ahead();
}

}  // namespace weft
