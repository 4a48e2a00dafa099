#include "engine/step/step.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <new>
#include <utility>

#include "engine/parallel/team.h"
#include "engine/step/air.h"
#include "engine/step/exact_substep.h"
#include "engine/step/flanks.h"
#include "engine/step/frame_plan.h"
#include "engine/step/held_apart.h"
#include "engine/step/plan.h"
#include "engine/step/pressure.h"
#include "engine/step/project.h"
#include "engine/step/report_errors.h"
#include "engine/step/reporting.h"
#include "engine/step/small_step.h"
#include "engine/step/tearing.h"
#include "engine/tuning.h"

namespace weft {
namespace {

/// The state at the beginning of a step: it comes back unless the step is committed.
class Transaction {
 public:
  explicit Transaction(State& s) : s_(s), refinement_(s.refinement) {
    s_.step_start.seams = s_.seams;
    s_.step_start.sliders = s_.sliders;
    s_.step_start.creases = s_.creases;
    const auto bodies = s_.bodies.free(s_.model->friction);
    s_.step_start.bodies.assign(bodies.begin(), bodies.end());
    s_.step_start.lost_energy = s_.lost_energy;
    s_.step_start.elastic_energy = s_.elastic_energy;
    s_.step_start.give_per_mass = s_.give_per_mass;
    s_.step_start.longest_substep = s_.longest_substep;
  }
  ~Transaction() {
    if (committed_) return;
    s_.refinement = refinement_;
    std::swap(s_.seams, s_.step_start.seams);
    std::swap(s_.sliders, s_.step_start.sliders);
    std::swap(s_.creases, s_.step_start.creases);
    s_.bodies.take(s_.step_start.bodies);
    s_.lost_energy = s_.step_start.lost_energy;
    s_.elastic_energy = s_.step_start.elastic_energy;
    s_.give_per_mass = s_.step_start.give_per_mass;
    s_.longest_substep = s_.step_start.longest_substep;
    if (!moves_) return;
    std::swap(s_.position, s_.step_start.position);
    std::swap(s_.velocity, s_.step_start.velocity);
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  /// Before particles move, but for the part that ends the step.
  void move() {
    if (moves_) return;
    s_.step_start.position = s_.position;
    s_.step_start.velocity = s_.velocity;
    moves_ = true;
  }
  void commit() { committed_ = true; }

 private:
  State& s_;
  const double refinement_;
  bool moves_ = false, committed_ = false;
};

/// Pins and anchors under way: whatever becomes of the step, pins stand in the end where they were
/// sent.
class Travel {
 public:
  Travel(State& s, double dt) : s_(s) {
    s.pins.depart(dt, s.position, s.velocity);
    s.anchors.depart(s.model->anchors, s.position, s.velocity, dt);
  }
  ~Travel() {
    s_.pins.stop(arrived_, s_.position, s_.velocity);
    s_.anchors.stop(arrived_);
  }
  Travel(const Travel&) = delete;
  Travel& operator=(const Travel&) = delete;

  void arrive() { arrived_ = true; }

 private:
  State& s_;
  bool arrived_ = false;
};

class OneStep {
 public:
  OneStep(State& s, StepReport& report, Team& team)
      : s_(s), report_(report), team_(team), transaction_(s) {}

  /// Returns whether all of dt was done.
  bool run(double dt) {
    if (s_.placed && s_.model->self_contact.on)
      timed(report_, Stage::commit, [&] { part_layers(); });
    if (s_.placed) s_.sliders.begin(*s_.model, s_.position);
    timed(report_, Stage::solve_positions, [&] {
      if (presses(s_)) find_forces(0, dt);
      const OutOfPlace found = find_out_of_place(s_, team_);
      if (!found.any()) return;
      transaction_.move();
      project(s_, found, dt, report_, team_);
    });
    if (s_.placed) {
      s_.longest_substep = 0;
      s_.seams.begin(*s_.model, s_.position, s_.settings.contact_tolerance);
    }
    timed(report_, Stage::predict, [&] {
      plan_ = plan_for(s_, dt, report_, team_);
      if (s_.laws && (s_.placed || s_.displaced)) find_elastic_energy(s_, dt / plan_.substeps);
    });
    for (int left = plan_.substeps; left > 0; --left) {
      if (!do_substep(dt / plan_.substeps, left)) return false;
    }
    transaction_.commit();
    for (std::size_t i = 0; i < s_.pressures.size(); ++i)
      if (s_.pressures[i].gas) s_.gas[i] = s_.pressed.given[i];
    s_.placed = s_.displaced = s_.rests_differ = false;
    s_.refinement = next_refinement();
    s_.lengthening = lengthening_;
    return true;
  }

 private:
  /// Layers that lie in one plane are on no side of each other.
  void part_layers() {
    if (!s_.coplanar_layers.find(*s_.model, *s_.kernels, s_.position)) return;
    transaction_.move();
    s_.coplanar_layers.part(*s_.model, s_.position);
  }
  /// Walks the list of attempts. Where a part is rejected the next attempt begins; where one is
  /// accepted the list begins again, at the end of that part.
  bool do_substep(double dt_substep, int substeps_left) {
    positions_ = share_of(report_.iterations, substeps_left);
    velocities_ = share_of(report_.velocity_iterations, substeps_left);
    int begin = 0;  // of the present part, in finest parts
    for (std::size_t i = 0; begin < kFinest;) {
      const Attempt& attempt = plan_.attempts[i];
      const int end = attempt.end_of(begin);
      if (end < kFinest || substeps_left > 1) transaction_.move();
      const Outcome outcome = try_attempt(attempt, dt_substep * (end - begin) / kFinest);
      if (outcome == Outcome::accepted) {
        begin = end;
        i = plan_.first_at(begin);
        ++parts_;
      } else if (!attempt.is_last) {
        ++i;
      } else {
        timed(report_, Stage::report, [&] { explain(s_, dt_substep, report_, team_); });
        return false;
      }
    }
    return true;
  }

  double next_refinement() const {
    if (refines_substeps(s_)) return refinement_;
    const double needed = report_.halvings > 0 ? std::log2(parts_ / plan_.substeps) : 0;
    return std::max(needed, s_.refinement - tuning::kCoarsening);
  }

  Outcome try_attempt(const Attempt& attempt, double dt_substep) {
    if (attempt.saves && report_.iterations >= positions_.early_end) return Outcome::rejected;
    const Budget budget{positions_.left(attempt, report_.iterations),
                        velocities_.left(attempt, report_.velocity_iterations)};
    bool is_predicted = std::exchange(plan_.is_predicted, false) && attempt.parts == 1;
    if (s_.total_force.size() > 0) {
      timed(report_, Stage::predict, [&] { find_velocity_forces_of(attempt, dt_substep); });
      is_predicted = false;
    }
    const Trial trial =
        attempt.method == Method::by_small_steps
            ? small_step(s_, attempt, dt_substep, budget, report_, team_)
            : exact_substep(s_, attempt, dt_substep, budget, is_predicted, report_, team_);
    if (trial.outcome == Outcome::accepted)
      accept(attempt, trial);
    else
      reject(attempt);
    return trial.outcome;
  }

  bool decays_before(const Attempt& attempt) const {
    return s_.model->damping.motion > 0 && attempt.method != Method::by_small_steps;
  }
  void find_velocity_forces_of(const Attempt& attempt, double dt_substep) {
    const bool decays = decays_before(attempt);
    if (attempt.method == Method::by_small_steps) {
      const AirPace air = find_air_pace(s_);
      s_.air_parts = parts_for_air(air, dt_substep);
      s_.air_turning = air.turning;
      const double part = dt_substep / s_.air_parts;
      return find_forces(0, s_.model->has_ram() ? std::max(part, least_held(dt_substep)) : part);
    }
    find_forces(decays ? s_.model->damping.motion : 0, dt_substep);
    if (!decays) return;
    s_.velocity_before_decay = s_.velocity;
    decay(s_, dt_substep);
  }

  /// s, how long the force of the air is held at least in a frame of small steps.
  double least_held(double dt_frame) const {
    const int substeps = s_.settings.substeps;
    return substeps == kAutomaticSubsteps ? std::min(dt_frame, tuning::kLongestSubstep)
                                          : dt_frame / substeps;
  }
  /// See find_velocity_forces.
  void find_forces(double decay, double dt_substep) {
    find_velocity_forces(s_, decay, dt_substep, team_);
    if (!presses(s_)) return;
    s_.pressed.beside = s_.total_force;
    begin_pressing(s_);
    press(s_, s_.position.view());
  }

  void reject(const Attempt& attempt) {
    if (decays_before(attempt)) std::swap(s_.velocity, s_.velocity_before_decay);
    if (!attempt.is_last)
      ++(attempt.scheme == Scheme::rattle ? report_.scheme_fallbacks : report_.halvings);
  }

  void accept(const Attempt& attempt, const Trial& trial) {
    std::swap(s_.position, s_.solved);
    std::swap(s_.velocity, s_.next_velocity);
    const bool in_vain = attempt.in_vain && trial.status == Status::iteration_limit;
    worsen(report_, in_vain ? Status::infeasible : trial.status);
    report_.substeps += trial.substeps;
    report_.pin_work += trial.pin_work;
    report_.energy_lost += trial.energy_lost;
    report_.seam_work += trial.seam_work;
    report_.motion_error += trial.motion_error;
    refinement_ = trial.refinement;
    lengthening_ = trial.lengthening;
    if (trial.passed_particle != kNoIndex) report_.passed_particle = trial.passed_particle;
  }

  /// The work of a substep, up to numbers of the report: all of it, and half of it for attempts
  /// that save the rest.
  struct Share {
    std::int64_t end = 0, early_end = 0;
    int left(const Attempt& attempt, std::int64_t done) const {
      const std::int64_t least = attempt.method == Method::by_small_steps ? 0 : 1;
      return static_cast<int>(std::max(least, (attempt.saves ? early_end : end) - done));
    }
  };
  /// Half of the iterations that the step has left are for each substep, and all for the last.
  Share share_of(std::int64_t done, int substeps_left) const {
    const std::int64_t left = s_.settings.max_iterations - done;
    const std::int64_t share = std::max<std::int64_t>(0, left / std::min(substeps_left, 2));
    return {done + share, done + share / 2};
  }

  State& s_;
  StepReport& report_;
  Team& team_;
  Transaction transaction_;
  Plan plan_;
  double parts_ = 0;              // done
  double refinement_ = 0;         // that small steps want next
  Lengthening lengthening_;       // likewise
  Share positions_, velocities_;  // of the iterations, for the present substep
};

}  // namespace

namespace {

/// Cloth that moved so little that it rests is brought to rest. Its report is that of the steps to
/// come, but for the work of this one.
void fall_asleep(State& s, StepReport& report) {
  const auto still = [&](std::size_t slot) {
    const double mass = s.model->inverse_mass[slot] > 0 ? s.model->mass[slot] : 0;
    const kernels::Vector v = s.velocity[slot];
    s.velocity.set(slot, {0, 0, 0});
    return 0.5 * mass * dot(v, v);
  };
  for (std::size_t slot = 0; slot < s.model->slots(); ++slot) report.energy_lost += still(slot);
  report.energy_lost += s.bodies.bring_to_rest();
  s.asleep = {.status = report.status,
              .asleep = true,
              .contacts = report.contacts,
              .max_strain = report.max_strain,
              .rms_strain = report.rms_strain,
              .max_shear = report.max_shear,
              .max_error = report.max_error,
              .max_bending_error = report.max_bending_error,
              .worst_constraint = report.worst_constraint,
              .worst_element = report.worst_element,
              .max_penetration = report.max_penetration,
              .body_contacts = report.body_contacts,
              .intersecting = report.intersecting,
              .self_contacts = report.self_contacts,
              .tangled = report.tangled,
              .max_anchor_error = report.max_anchor_error,
              .open_seams = report.open_seams,
              .max_seam_gap = report.max_seam_gap,
              .late_seams = report.late_seams,
              .worst_seam = report.worst_seam,
              .held_apart = report.held_apart,
              .worst_held = report.worst_held,
              .max_rail_gap = report.max_rail_gap,
              .law_error = report.law_error};
}

/// J. Where bodies overlap, and wherever else a step misses its tolerance, contacts shake
/// particles. Their slip is no motion then, and counts as far as energy was lost.
double friction_work(const StepReport& report, double counted) {
  if (report.status == Status::converged) return counted;
  return std::min(counted, std::max(0.0, report.energy_lost));
}

void tell_held_apart(const State& s, StepReport& report) {
  const HeldApart found = find_held_apart(s);
  report.held_apart = found.count;
  report.worst_held = found.constraint;
  if (report.worst_seam == kNoIndex) report.worst_seam = found.seam;
  if (found.is_infeasible && s.settings.iterations == 0) worsen(report, Status::infeasible);
}

void advance(State& s, double dt, StepReport& report, Team& team) {
  bool done = false;
  s.way_per_second = 1 / dt;
  std::ranges::fill(s.contacts.met, 0);
  {
    Travel travel(s, dt);
    done = OneStep(s, report, team).run(dt);
    if (done) {
      travel.arrive();
      s.bodies.arrive(s.body_report.impulses, dt);
      report.body_contacts = s.body_report.contacts;
      report.body_work = s.body_report.work;
      report.friction_work = friction_work(report, s.body_report.friction);
      report.contact_failures = s.body_report.failures.failures;
      report.zones = s.body_report.failures.zones;
      report.intersecting = s.body_report.failures.left;
      report.self_contacts = s.body_report.within_cloth;
      report.tangled = s.body_report.failures.tangled;
      report.untangling_work = s.body_report.untangling;
      s.way = {};
    }
  }
  // Small steps have measured what they committed.
  if (!done || s.settings.solver != Solver::small_steps) {
    timed(report, Stage::report, [&] { report_errors(s, s.position, done, report, team); });
  }
  if (done) tell_held_apart(s, report);
  const bool is_sewing = report.open_seams > report.late_seams;
  if (s.bodies.fastest() > s.rest.slowest()) s.rest.wake();
  if (done && s.settings.sleep && !is_sewing && s.rest.watch(s.position, dt))
    fall_asleep(s, report);
}

}  // namespace

namespace {

/// Where memory runs out nothing is torn: what is overloaded is so in the next step, too.
void tear_what_breaks(State& s, StepReport& report) {
  try {
    if (tear(s)) report.torn = static_cast<int>(s.torn.size());
  } catch (const std::bad_alloc&) {
  }
}

}  // namespace

StepReport step(State& s, double dt, Team& team) {
  s.torn.clear();
  if (s.rest.is_asleep()) return s.asleep;
  StepReport report;
  timed(report, Stage::commit, [&] {
    advance(s, dt, report, team);
    if ((s.model->may_tear || has_flanks(*s.model)) && committed(report.status))
      tear_what_breaks(s, report);
  });
  return report;
}

}  // namespace weft
