#include "engine/step/small_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/contacts/contacts.h"
#include "engine/contacts/crossings.h"
#include "engine/step/energy.h"
#include "engine/step/measure.h"
#include "engine/step/motion.h"
#include "engine/step/pin_work.h"
#include "engine/step/project.h"
#include "engine/step/reporting.h"
#include "engine/step/solve.h"
#include "engine/step/substep.h"
#include "engine/step/transaction.h"
#include "engine/tuning.h"

namespace weft {
namespace {

/// m/s^2, of gravity and forces: the mean magnitude, by mass.
double mean_acceleration(const State& s) {
  if (s.force.size() == 0) return length(s.gravity);
  double sum = 0, mass = 0;
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    if (s.model->inverse_mass[slot] == 0) continue;
    mass += s.model->mass[slot];
    sum += s.model->mass[slot] * length(acceleration(s, slot));
  }
  return mass > 0 ? sum / mass : 0;
}

/// Substeps are about as long as the load allows. In a step that is far shorter than that
/// corrections are smaller: a sweep is a spring of stiffness omega / h^2, and a spring that keeps
/// its stiffness releases nothing of what it holds.
template <class Solver>
FramePlan plan_for(State& s, const Solver& solver, double dt) {
  FramePlan plan{.h = dt, .omega = tuning::kOmega, .placed = s.placed};
  if (s.settings.substeps != kAutomaticSubsteps) {
    plan.substeps = s.settings.substeps;
  } else {
    const double usual = std::min(tuning::kLongestSubstep,
                                  solver.substep_length(s.position.view(), mean_acceleration(s)));
    const double wanted = std::ceil(dt / usual);
    const int most = std::min(tuning::kMostSubsteps, s.settings.max_iterations);
    plan.substeps = wanted < most ? std::max(1, static_cast<int>(wanted)) : most;
    const double part = 2 * dt / (plan.substeps * usual);
    if (part < 1) plan.omega *= part * part;
  }
  plan.h = dt / plan.substeps;
  return plan;
}

/// The frame that is being done.
template <class Solver>
class Frame {
 public:
  Frame(State& s, Solver& solver, StepReport& report, Team& team)
      : s_(s),
        solver_(solver),
        report_(report),
        team_(team),
        edges_(static_cast<std::int64_t>(s.model->constraints.size())) {}

  void begin(const FramePlan& plan) {
    const kernels::VectorsView force =
        s_.force.size() > 0 ? s_.force.view() : kernels::VectorsView{};
    if (s_.model->has_contacts()) s_.substep_start = s_.position;
    solver_.begin(s_.position.view(), s_.velocity.view(), s_.gravity, force, plan, team_);
  }

  void substep() {
    solver_.advance(team_);
    const bool to_tolerance = s_.settings.iterations == 0;
    for (int i = 0; i < std::max(1, s_.settings.iterations); ++i) sweep();
    if (to_tolerance && many_are_out()) sweep();
    if (s_.model->has_contacts()) find_contacts();
    if (to_tolerance) count(solver_.repair(s_.contacts, most_visits(tuning::kMostVisits)));
    if (s_.model->has_contacts()) watch_crossings();
    ++report_.substeps;
  }

  /// Puts right what the last substep left out of tolerance, in rounds of a sweep and local passes
  /// that look at all constraints. If rounds no longer bring the error down it is there to stay.
  Status finish() {
    read_positions();
    double worst = std::numeric_limits<double>::infinity();
    for (int round = 0, stalled = 0;; ++round) {
      if (is_within_tolerance()) return Status::converged;
      if (s_.settings.iterations > 0) return Status::fixed_iterations;
      if (round >= most_rounds()) return Status::iteration_limit;
      const double now = std::max(report_.max_strain / s_.settings.tolerance,
                                  report_.max_penetration / s_.settings.contact_tolerance);
      stalled = now < tuning::kFall * worst ? 0 : stalled + 1;
      if (stalled > tuning::kPatience) return Status::infeasible;
      worst = std::min(worst, now);
      timed(report_, Stage::solve_positions, [&] { put_right(); });
    }
  }

  void read_velocities() {
    solver_.settle(team_);
    solver_.read_velocities(s_.next_velocity.view(), team_);
  }

  /// Of what is solved, into the report.
  bool is_within_tolerance() {
    timed(report_, Stage::report, [&] { report_errors(s_, s_.solved, report_, team_); });
    return report_.max_strain <= s_.settings.tolerance &&
           report_.max_penetration <= s_.settings.contact_tolerance;
  }

 private:
  /// With a number of substeps that was given the time of a frame is to be bounded.
  int most_rounds() const {
    if (report_.iterations >= s_.settings.max_iterations) return 0;
    return s_.settings.substeps == kAutomaticSubsteps ? tuning::kMostRounds : 1;
  }
  void put_right() {
    sweep();
    count(solver_.repair_everywhere(s_.contacts, most_visits(tuning::kMostRoundVisits)));
    read_positions();
  }
  void sweep() {
    solver_.sweep(team_);
    ++report_.iterations;
    ++report_.direction_updates;
    report_.visits += edges_;
    report_.corrections += edges_;
  }
  bool many_are_out() const {
    return static_cast<double>(solver_.count_out()) >
           tuning::kManyOut * static_cast<double>(edges_);
  }

  std::int64_t most_visits(std::int64_t sweeps) const {
    const std::int64_t left = s_.settings.max_iterations - report_.iterations;
    return std::max<std::int64_t>(1, std::min(sweeps, left)) * edges_;
  }
  void count(const LocalWork& work) {
    report_.visits += work.visits;
    report_.corrections += work.corrections;
    if (edges_ > 0) report_.iterations += work.visits / edges_;
  }
  void read_positions() {
    s_.solved = s_.position;
    solver_.read_positions(s_.solved.view(), team_);
    s_.pins.place(s_.solved);
  }
  void find_contacts() {
    read_positions();
    weft::find_contacts(*s_.model, *s_.kernels, s_.solved.view(), s_.contacts);
  }
  void watch_crossings() {
    read_positions();
    const std::uint32_t passed = find_crossing(*s_.model, *s_.kernels, s_.substep_start.view(),
                                               s_.solved.view(), s_.contacts);
    if (passed != kNoIndex) {
      report_.passed_particle = s_.model->ordering.particle_at[passed];
      worsen(report_, Status::passed_through);
    }
    s_.substep_start = s_.solved;
  }

  State& s_;
  Solver& solver_;
  StepReport& report_;
  Team& team_;
  const std::int64_t edges_;
};

/// A frame gains no energy but what forces and pins bring in.
void guard_energy(State& s, const kernels::Kicks& change, double dt, StepReport& report) {
  if (s.settings.iterations == 0) take_gained_energy(s, change, dt);
  if (s.pins.moving()) report.pin_work = work_of(motion_of_pins(s, dt), s, dt);
}

template <class Solver>
bool run(State& s, Solver& solver, double dt, bool jumped, StepReport& report, Team& team) {
  Transaction transaction(s);
  if ((s.placed || jumped) && violates_constraints(s, team)) {
    transaction.begin();
    project(s, dt, 1, report, team);
  }
  Frame<Solver> frame(s, solver, report, team);
  FramePlan plan;
  timed(report, Stage::predict, [&] {
    plan = plan_for(s, solver, dt);
    frame.begin(plan);
  });
  timed(report, Stage::solve_positions, [&] {
    for (int i = 0; i < plan.substeps; ++i) frame.substep();
  });
  const Status status = frame.finish();
  kernels::Kicks change;
  timed(report, Stage::commit, [&] {
    frame.read_velocities();
    change = measure_energy_change(s, team);
  });
  // A position is no number only where the velocity is none.
  if (!std::isfinite(change.energy)) {
    explain(s, dt, report, team);
    return false;
  }
  worsen(report, s.settings.iterations > 0 ? Status::fixed_iterations : status);
  timed(report, Stage::commit, [&] { guard_energy(s, change, dt, report); });
  timed(report, Stage::commit, [&] {
    solver.keep(team);
    transaction.accept();
    transaction.complete();
  });
  s.placed = false;
  return true;
}

}  // namespace

bool run_small_steps(State& s, double dt, bool jumped, StepReport& report, Team& team) {
  return s.small_steps ? run(s, *s.small_steps, dt, jumped, report, team)
                       : run(s, *s.reference_small_steps, dt, jumped, report, team);
}

}  // namespace weft
