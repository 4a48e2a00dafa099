#include "engine/step/substep.h"

#include <algorithm>
#include <cstdint>

#include "engine/contacts/contacts.h"
#include "engine/contacts/crossings.h"
#include "engine/step/energy.h"
#include "engine/step/motion.h"
#include "engine/step/pin_work.h"
#include "engine/step/rattle.h"
#include "engine/step/reporting.h"

namespace weft {

void find_contacts(State& s, StepReport& report) {
  if (!s.model->has_contacts()) return;
  timed(report, Stage::find_contacts,
        [&] { find_contacts(*s.model, *s.kernels, s.solved.view(), s.contacts); });
}

namespace {

/// Of an attempt that nothing is tried in place of.
Trial watch_crossings(State& s, StepReport& report, Trial trial) {
  if (!s.model->has_contacts() || !trial.has_result()) return trial;
  timed(report, Stage::find_contacts, [&] {
    const std::uint32_t passed =
        find_crossing(*s.model, *s.kernels, s.position.view(), s.solved.view(), s.contacts);
    if (passed == kNoIndex) return;
    trial.passed_particle = s.model->ordering.particle_at[passed];
    trial.worsen(Status::passed_through);
  });
  return trial;
}

/// An attempt by scheme rattle whose positions miss their tolerance is not worth its velocities: as
/// a rule it is far beyond any numbers that a velocity loop could end with.
bool blown_up(const State& s, const Attempt& attempt, const Trial& trial) {
  return attempt.by_rattle() && s.settings.iterations == 0 && trial.status != Status::converged;
}

/// Yarns and the direct solver may solve, by scheme paper, for what is not where the motion leads:
/// see energy.h. And what one
/// substep was cut off from is speed in the next, whose end is still farther: a net under a pin
/// that jumps by 1 m, 500 iterations a step, came to 10 km/s.
bool may_gain_energy(const State& s, const Attempt& attempt, const Trial& trial) {
  const bool exact = s.yarn || s.direct;
  const bool cut_off = trial.status == Status::iteration_limit;
  return (exact || cut_off) && s.settings.iterations == 0 && !attempt.by_rattle();
}

/// Where nobody is going to try anything else it is kept, and its energy taken out.
void watch_energy(const State& s, const Attempt& attempt, const kernels::Kicks& kicks,
                  Trial& trial) {
  if (trial.ended != Ended::solved || !gains_energy(s, kicks, attempt.h)) return;
  trial.gained = true;
  trial.worsen(attempt.on_failure == OnFailure::sweep ? Ended::made_do : Ended::gave_up);
}

Trial run_stages(State& s, const Attempt& attempt, StepReport& report, Team& team) {
  const double h = attempt.h;
  if (!attempt.predicted) timed(report, Stage::predict, [&] { predict(s, h, team); });
  find_contacts(s, report);
  Trial trial;
  timed(report, Stage::solve_positions, [&] { trial = solve_positions(s, attempt, report, team); });
  if (trial.ended == Ended::gave_up || blown_up(s, attempt, trial)) return trial;
  bool finite = true;
  const bool watched = may_gain_energy(s, attempt, trial);
  kernels::Kicks kicks;
  timed(report, Stage::commit,
        [&] { finite = watched ? commit(s, h, kicks, team) : commit(s, h, team); });
  if (finite && s.settings.velocity_correction) {
    timed(report, Stage::correct_velocities,
          [&] { trial.worsen(correct_velocities(s, attempt, report, team)); });
    finite = all_finite(s.next_velocity);
    if (watched) kicks = measure_kicks(s, h, team);
  }
  if (!finite) {
    trial.ended = Ended::lost;
    return trial;
  }
  if (watched) watch_energy(s, attempt, kicks, trial);
  if (s.settings.iterations > 0 && trial.status <= Status::iteration_limit) {
    trial.status = Status::fixed_iterations;
  }
  return trial;
}

/// Of its first measure the work of moved pins is taken away, if need be.
bool rattle_keeps_energy(State& s, double h, Team& team) {
  kernels::Kicks kicks = measure_kicks(s, h, team);
  if (keeps_energy(kicks)) return true;
  kicks.gain -= 2 * work_of(motion_of_pins(s, h), s, h);
  return keeps_energy(kicks);
}

/// Whether what scheme rattle came to is kept. With a fixed number of iterations it always is.
bool is_good(State& s, const Trial& trial, double h, Team& team) {
  if (s.settings.iterations > 0) return true;
  return trial.status == Status::converged && trial.has_result() && rattle_keeps_energy(s, h, team);
}

int half_of(int most) { return std::max(1, most / 2); }
int left_of(int most, std::int64_t done) {
  return static_cast<int>(std::max<std::int64_t>(1, most - done));
}

}  // namespace

/// Until it is accepted a substep leaves position and velocity alone: it can be done again.
Trial substep(State& s, const Attempt& attempt, StepReport& report, Team& team) {
  if (s.settings.scheme == Scheme::paper) {
    return watch_crossings(s, report, run_stages(s, attempt, report, team));
  }
  const std::int64_t done = report.iterations, of_velocities = report.velocity_iterations;
  Attempt by_rattle = attempt;
  by_rattle.start = s.position.view();
  by_rattle.most_iterations = half_of(attempt.most_iterations);
  by_rattle.most_velocity_iterations = half_of(attempt.most_velocity_iterations);
  const Trial trial = run_stages(s, by_rattle, report, team);
  if (is_good(s, trial, attempt.h, team)) return watch_crossings(s, report, trial);
  ++report.scheme_fallbacks;
  Attempt by_paper = attempt;
  by_paper.predicted = false;
  by_paper.most_iterations = left_of(attempt.most_iterations, report.iterations - done);
  by_paper.most_velocity_iterations =
      left_of(attempt.most_velocity_iterations, report.velocity_iterations - of_velocities);
  return watch_crossings(s, report, run_stages(s, by_paper, report, team));
}

}  // namespace weft
