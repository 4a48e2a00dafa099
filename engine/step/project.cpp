#include "engine/step/project.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "engine/measure/state_measure.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/solvers/stall.h"
#include "engine/step/exact_substep.h"
#include "engine/step/fast_springs.h"
#include "engine/step/motion.h"
#include "engine/step/report_errors.h"
#include "engine/step/reporting.h"
#include "engine/step/small_step.h"
#include "engine/tuning.h"

namespace weft {
namespace {

bool is_out_of_tolerance(State& s, Team& team) {
  if (largest_rail_gap(*s.model, s.sliders.places(), s.position) > s.settings.contact_tolerance)
    return true;
  if (s.anchors.largest_excess(s.model->anchors, s.position, false) > s.settings.contact_tolerance)
    return true;
  if (!s.model->constraints.has_springs())
    return s.measure->error(s.position.view(), nullptr, s.contacts, team) > 1;
  return largest_rigid_strain(s) > s.settings.tolerance ||
         s.measure->penetration(s.position.view(), s.contacts) > s.settings.contact_tolerance;
}

/// Where a substep from rest leads, into solved.
void look_ahead(State& s, double h, Team& team) {
  StepReport unused;
  if (s.settings.solver == Solver::small_steps)
    return look_ahead_by_small_steps(s, h, unused, team);
  s.solved = s.position;
  for (std::size_t slot = 0; slot < s.model->slots(); ++slot) {
    if (s.model->inverse_mass[slot] > 0) s.solved.view().add(slot, h * h * acceleration(s, slot));
  }
  s.laws->begin(*s.model, s.position.view(), h, s.settings.tolerance);
  find_contacts(s, unused);
  const PositionTask task{.x = s.solved.view(),
                          .start = s.position.view(),
                          .contacts = s.contacts,
                          .dt_substep = h,
                          .max_iterations = std::max(1, s.settings.max_iterations / 2),
                          .laws = &*s.laws};
  solve_positions(s, *s.solver, task, unused, team);
}

/// m
double largest_way(const kernels::Vectors& from, const kernels::Vectors& to) {
  double most = 0;
  for (std::size_t i = 0; i < from.size(); ++i) most = std::max(most, length(to[i] - from[i]));
  return most;
}

/// Fast springs of which a pin was teleported, or whose rest has changed. Where positions
/// were given they are misplaced if in a moment from rest they would become fast by changing their
/// lengths: the load of a cloth does not.
bool springs_are_misplaced(State& s, Team& team) {
  if (!s.model->has_laws() || softest_of_fast(*s.model) == 0) return false;
  if (s.rests_differ) return true;
  if (s.placed) {
    constexpr double kMoment = tuning::kLongestSubstep;
    look_ahead(s, kMoment, team);
    if (largest_way(s.position, s.solved) < tuning::kMisplacedSpeed * kMoment) return false;
  } else {
    s.solved = s.position;
    s.pins.undo_teleports(s.solved);
  }
  return largest_change_of_fast(*s.model, s.position, s.solved) > s.settings.tolerance;
}

}  // namespace

OutOfPlace find_out_of_place(State& s, Team& team) {
  if (s.settings.iterations > 0 || !(s.placed || s.displaced)) return {};
  return {.edges = is_out_of_tolerance(s, team), .springs = springs_are_misplaced(s, team)};
}

namespace {

class Projection {
 public:
  Projection(State& s, StepReport& report, Team& team)
      : s_(s), report_(report), team_(team), most_((s.settings.max_iterations + 1) / 2) {}

  void put_edges_right(double dt) {
    solve(0, dt);
    if (all_finite(s_.solved)) s_.position = s_.solved;
  }

  /// The load of the fabric before pins were teleported pulls as before: its way in the time of a
  /// round, from where the pins were, is taken back in each round.
  void put_springs_right() {
    const double softest = softest_of_fast(*s_.model);
    const bool carries = s_.pins.were_teleported() && !s_.placed;
    kernels::Vectors before, drift;
    if (carries) {
      before = s_.position;
      s_.pins.undo_teleports(before);
    }
    for (const double h : {tuning::kPlacing, tuning::kLongestSubstep}) {
      if (carries) drift = find_drift(before, softest, h);
      Stall stall(tuning::kPlacingPatience);
      while (left() > 0) {
        solve(softest, h);
        if (!all_finite(s_.solved)) return;
        if (carries) subtract(drift);
        const double speed = largest_way(s_.position, s_.solved) / h;
        s_.position = s_.solved;
        if (is_wedged()) return;
        if (speed < tuning::kPlacedSpeed || stall.has_stalled(speed)) break;
      }
    }
  }

 private:
  kernels::Vectors find_drift(const kernels::Vectors& from, double softest, double h) {
    kernels::Vectors start = std::exchange(s_.position, from), drift(from.size());
    solve(softest, h);
    if (all_finite(s_.solved)) {
      for (std::size_t i = 0; i < drift.size(); ++i) drift.set(i, s_.solved[i] - from[i]);
    }
    s_.position = std::move(start);
    return drift;
  }
  void subtract(const kernels::Vectors& drift) {
    for (std::size_t i = 0; i < drift.size(); ++i) s_.solved.set(i, s_.solved[i] - drift[i]);
  }
  /// Fabric met itself or a body where no impact stopped it. Further rounds would drive it in, so
  /// the rest is left to its motion.
  bool is_wedged() {
    if (!has_begun_) return false;
    s_.small_steps->report_bodies(s_.body_report);
    return s_.body_report.failures.zones > 0;
  }
  int left() const {
    return static_cast<int>(std::max<std::int64_t>(0, most_ - report_.iterations));
  }
  /// solved: from position onto the constraints. Springs up to the compliance `softest` have the
  /// time h to give way; others are left as they are.
  void solve(double softest, double h) {
    s_.solved = s_.position;
    find_contacts(s_, report_);
    timed(report_, Stage::solve_positions, [&] {
      if (s_.settings.solver == Solver::small_steps) return by_small_steps(softest, h);
      if (s_.laws) {
        s_.laws->begin_projection(*s_.model, softest, h, s_.settings.tolerance);
      }
      const PositionTask task{.x = s_.solved.view(),
                              .start = s_.position.view(),
                              .contacts = s_.contacts,
                              .dt_substep = h,
                              .max_iterations = std::max(1, s_.small_steps ? left() / 2 : left()),
                              .laws = s_.laws ? &*s_.laws : nullptr};
      const auto result = solve_positions(s_, *s_.solver, task, report_, team_);
      if (!result.converged && s_.small_steps) {
        s_.solved = s_.position;
        by_small_steps(softest, h);
      }
    });
  }
  void by_small_steps(double softest, double h) {
    const bool goes_on = std::exchange(has_begun_, true);
    project_by_small_steps(s_, softest, h, goes_on, {.positions = left()}, report_, team_);
  }

  State& s_;
  StepReport& report_;
  Team& team_;
  const std::int64_t most_;  // iterations
  bool has_begun_ = false;   // small steps
};

}  // namespace

void project(State& s, const OutOfPlace& what, double dt, StepReport& report, Team& team) {
  Projection projection(s, report, team);
  if (what.springs) return projection.put_springs_right();
  projection.put_edges_right(dt);
}

void explain(State& s, double h, StepReport& report, Team& team) {
  const std::size_t solved = first_not_finite(*s.model, s.solved, s.next_velocity);
  predict(s, h, team);
  const std::size_t predicted = first_not_finite(*s.model, s.solved, s.solved);
  const bool input = predicted < s.model->slots();
  report.failed_particle = s.model->ordering.particle_at[input ? predicted : solved];
  report.passed_particle = kNoIndex;
  report.substeps = 0;
  report.pin_work = 0;
  worsen(report, input ? Status::non_finite_input : Status::non_finite);
}

}  // namespace weft
