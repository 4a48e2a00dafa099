#include "engine/step/exact_substep.h"

#include <algorithm>
#include <cstdint>

#include "engine/measure/state_measure.h"
#include "engine/solvers/sweeps/sweeps.h"
#include "engine/spheres/passages.h"
#include "engine/spheres/sphere_contacts.h"
#include "engine/step/energy.h"
#include "engine/step/motion.h"
#include "engine/step/pin_work.h"
#include "engine/step/reporting.h"

namespace weft {

void find_contacts(State& s, StepReport& report) {
  if (!s.model->has_spheres()) return;
  timed(report, Stage::find_contacts,
        [&] { find_contacts(*s.model, *s.kernels, s.solved.view(), s.contacts); });
}

kernels::LoopResult solve_positions(State& s, ConstraintSolver& solver, PositionTask task,
                                    StepReport& report, Team& team) {
  /// Each round adds a contact at least; in practice one round is rare, and two were not seen.
  constexpr int kMostRounds = 16;
  kernels::LoopResult sum;
  for (int round = 0; round < kMostRounds; ++round) {
    const kernels::LoopResult result = solver.solve_positions(task, team);
    count(sum, result);
    sum.failed = result.failed;
    task.first_round = false;
    task.max_iterations = std::max(1, task.max_iterations - result.iterations);
    const bool again = s.model->has_spheres() && result.converged &&
                       add_missed_contacts(*s.model, *s.kernels, task.x,
                                           s.settings.contact_tolerance, s.contacts) > 0;
    if (!again) break;
    sum.converged = false;
  }
  report.iterations += sum.iterations;
  report.direction_updates += sum.direction_updates;
  report.visits += sum.visits;
  report.corrections += sum.corrections;
  return sum;
}

void find_elastic_energy(State& s, double dt_substep) {
  s.elastic_energy = energy_of_springs(*s.model, s.position, dt_substep * dt_substep);
}

Status correct_velocities(State& s, ConstraintSolver& solver, bool exact, const Budget& budget,
                          StepReport& report, Team& team) {
  VelocityTask task{.x = s.solved.view(),
                    .v = s.next_velocity.view(),
                    .contacts = s.contacts,
                    .exact = exact,
                    .max_iterations = budget.velocities};
  kernels::LoopResult result;
  const bool is_fixed = s.settings.iterations > 0;
  for (ConstraintSolver* next :
       {&solver, s.stand_in, static_cast<ConstraintSolver*>(s.sweeps.get())}) {
    const bool is_done = result.iterations > 0 && (result.converged || is_fixed);
    if (is_done || next == nullptr) continue;
    task.max_iterations = std::max(1, budget.velocities - result.iterations);
    count(result, next->correct_velocities(task, team));
    task.exact = false;  // removed once already
  }
  report.velocity_iterations += result.iterations;
  report.visits += result.visits;
  report.corrections += result.corrections;
  return is_fixed || result.converged ? Status::converged : Status::iteration_limit;
}

namespace {

/// A substep that is being done.
class ExactSubstep {
 public:
  ExactSubstep(State& s, const Attempt& attempt, double dt_substep, const Budget& budget,
               StepReport& report, Team& team)
      : s_(s),
        attempt_(attempt),
        dt_substep_(dt_substep),
        budget_(budget),
        report_(report),
        team_(team) {}

  Trial run(bool is_predicted) {
    if (!is_predicted) timed(report_, Stage::predict, [&] { predict(s_, dt_substep_, team_); });
    find_contacts(s_, report_);
    timed(report_, Stage::solve_positions, [&] { solve_positions(); });
    if (trial_.outcome != Outcome::accepted) return trial_;
    timed(report_, Stage::commit, [&] { set_velocities(); });
    if (s_.settings.velocity_correction && trial_.outcome == Outcome::accepted) {
      timed(report_, Stage::correct_velocities, [&] { correct_velocities(); });
    }
    if (trial_.outcome != Outcome::accepted) return trial_;
    if (s_.laws) release_energy();
    watch_energy();
    if (s_.pins.moving())
      trial_.pin_work = work_of(motion_of_pins(s_, dt_substep_), s_, dt_substep_);
    if (needs_energy() && !corrects_longer_substeps())
      trial_.energy_lost = trial_.pin_work - 0.5 * impulses_.gain;
    watch_crossings();
    if (is_fixed()) trial_.status = std::max(trial_.status, Status::fixed_iterations);
    if (trial_.outcome != Outcome::accepted) return trial_;
    if (s_.laws) keep_springs();
    s_.longest_substep = std::max(s_.longest_substep, dt_substep_);
    return trial_;
  }

 private:
  bool is_fixed() const { return s_.settings.iterations > 0; }
  bool is_by_rattle() const { return attempt_.scheme == Scheme::rattle; }
  ConstraintSolver& solver() const {
    if (attempt_.method == Method::by_stand_in) return *s_.stand_in;
    return attempt_.method == Method::by_sweeps ? *s_.sweeps : *s_.solver;
  }

  void solve_positions() {
    if (s_.laws) s_.laws->begin(*s_.model, s_.position.view(), dt_substep_, s_.settings.tolerance);
    const PositionTask task{.x = s_.solved.view(),
                            .start = s_.position.view(),
                            .contacts = s_.contacts,
                            .dt_substep = dt_substep_,
                            .along_start = is_by_rattle(),
                            .max_iterations = budget_.positions,
                            .laws = s_.laws ? &*s_.laws : nullptr};
    auto result = weft::solve_positions(s_, solver(), task, report_, team_);
    if (is_fixed()) {
      // A fixed number that the direct solver cannot do, since the system has no solution.
      if (result.iterations == 0) weft::solve_positions(s_, *s_.sweeps, task, report_, team_);
      return;
    }
    is_solved_ = result.converged;
    // Within tolerance, but short of what the solver aims at: the next part would begin with that.
    const bool is_short = result.failed && attempt_.parts < kFinest;
    if ((!is_solved_ || is_short) && !attempt_.is_last) trial_.outcome = Outcome::rejected;
    if (!result.converged) {
      trial_.status = result.failed ? Status::infeasible : Status::iteration_limit;
    }
  }

  void set_velocities() {
    const bool finite =
        needs_energy() ? commit(s_, dt_substep_, impulses_, team_) : commit(s_, dt_substep_, team_);
    if (!finite) trial_.outcome = Outcome::not_finite;
  }

  void correct_velocities() {
    trial_.worsen(weft::correct_velocities(s_, solver(), is_by_rattle(), budget_, report_, team_));
    if (is_by_rattle() && !is_fixed() && !attempt_.is_last && trial_.status != Status::converged) {
      trial_.outcome = Outcome::rejected;
    }
    if (!all_finite(s_.next_velocity)) trial_.outcome = Outcome::not_finite;
    if (needs_energy()) impulses_ = measure_impulses(s_, dt_substep_, team_);
  }

  bool is_papers_loop() const { return s_.settings.solver == Solver::gauss_seidel; }
  /// The paper's loop leaves errors within the tolerance. A solver that corrects in h the error of
  /// a longer substep gains energy by that.
  bool corrects_longer_substeps() const {
    return is_papers_loop() && !is_by_rattle() && dt_substep_ < s_.longest_substep;
  }
  /// The paper's loop is left as it is where it converges: its gains belong to it. Others, and a
  /// loop that was cut off, may lead to a state that keeps the constraints far from the prediction.
  bool needs_energy() const {
    if (is_fixed()) return false;
    return is_by_rattle() || !is_papers_loop() || !is_solved_ || corrects_longer_substeps();
  }

  /// Energy that springs have released is no gain.
  void release_energy() {
    elastic_energy_ = energy_of_tensions(*s_.laws, s_.model->constraints, dt_substep_);
    impulses_.gain -= 2 * (s_.elastic_energy - elastic_energy_);
  }

  void keep_springs() {
    s_.elastic_energy = elastic_energy_;
    s_.give_per_mass = dt_substep_ * dt_substep_;
    report_.max_error = s_.settings.tolerance *
                        largest_violation(*s_.laws, s_.model->constraints, s_.solved.view());
  }

  void watch_energy() {
    if (!needs_energy()) return;
    if (is_by_rattle() && !attempt_.is_last) {
      if (gains_energy(s_, impulses_, dt_substep_)) trial_.outcome = Outcome::rejected;
      return;
    }
    const bool is_suspect =
        attempt_.method != Method::by_solver || attempt_.parts > 1 || corrects_longer_substeps();
    const bool is_kept = guard_energy(s_, impulses_, is_suspect, dt_substep_);
    if (!is_kept && !is_suspect && !attempt_.is_last) trial_.outcome = Outcome::rejected;
  }

  void watch_crossings() {
    if (!s_.model->has_spheres()) return;
    timed(report_, Stage::find_contacts, [&] {
      const std::uint32_t passed =
          find_passage(*s_.model, *s_.kernels, s_.position.view(), s_.solved.view(), s_.contacts);
      if (passed == kNoIndex) return;
      trial_.passed_particle = s_.model->ordering.particle_at[passed];
      trial_.worsen(Status::passed_through);
    });
  }

  State& s_;
  const Attempt& attempt_;
  const double dt_substep_;
  const Budget budget_;
  StepReport& report_;
  Team& team_;
  Trial trial_;
  bool is_solved_ = true;
  kernels::ImpulseEnergy impulses_;
  double elastic_energy_ = 0;  // J, of springs in the end
};

}  // namespace

Trial exact_substep(State& s, const Attempt& attempt, double dt_substep, const Budget& budget,
                    bool is_predicted, StepReport& report, Team& team) {
  return ExactSubstep(s, attempt, dt_substep, budget, report, team).run(is_predicted);
}

}  // namespace weft
