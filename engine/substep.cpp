#include "engine/substep.h"

#include <utility>

#include "engine/contacts.h"
#include "engine/crossings.h"
#include "engine/motion.h"
#include "engine/rattle.h"
#include "engine/reporting.h"

namespace weft {

void find_contacts(State& s, StepReport& report) {
  if (!s.model->has_contacts()) return;
  timed(report, Stage::find_contacts,
        [&] { find_contacts(*s.model, *s.kernels, s.solved.view(), s.contacts); });
}

namespace {

void watch_crossings(State& s, StepReport& report) {
  const std::uint32_t passed =
      find_crossing(*s.model, *s.kernels, s.position.view(), s.solved.view(), s.contacts.found);
  if (passed == kNoIndex) return;
  report.passed_particle = s.model->ordering.particle_at[passed];
  worsen(report, Status::passed_through);
}

/// An attempt by scheme rattle whose positions miss their tolerance is not worth its velocities: as
/// a rule it is far beyond any numbers that a velocity loop could end with.
bool blown_up(const State& s, const Attempt& attempt, const StepReport& report) {
  return attempt.start.x != nullptr && s.settings.iterations == 0 &&
         report.status != Status::converged;
}

Ended run_stages(State& s, const Attempt& attempt, StepReport& report, Team& team) {
  const double h = attempt.h;
  if (!attempt.predicted) timed(report, Stage::predict, [&] { predict(s, h, team); });
  find_contacts(s, report);
  Ended ended = Ended::solved;
  timed(report, Stage::solve_positions, [&] { ended = solve_positions(s, attempt, report, team); });
  if (ended == Ended::gave_up || blown_up(s, attempt, report)) return ended;
  bool finite = true;
  timed(report, Stage::commit, [&] { finite = commit(s, h, team); });
  if (!finite) return Ended::lost;
  if (s.settings.velocity_correction) {
    timed(report, Stage::correct_velocities, [&] { correct_velocities(s, attempt, report, team); });
    if (!all_finite(s.next_velocity)) return Ended::lost;
  }
  if (s.settings.iterations > 0 && report.status <= Status::iteration_limit) {
    report.status = Status::fixed_iterations;
  }
  if (s.model->has_contacts()) {
    timed(report, Stage::find_contacts, [&] { watch_crossings(s, report); });
  }
  return ended;
}

}  // namespace

/// Until it is accepted a substep leaves position and velocity alone: it can be done again. With a
/// fixed number of iterations it is not.
Ended substep(State& s, const Attempt& attempt, StepReport& report, Team& team) {
  if (s.settings.scheme == Scheme::paper) return run_stages(s, attempt, report, team);
  const Status before = std::exchange(report.status, Status::converged);
  Attempt by_rattle = attempt;
  by_rattle.start = s.position.view();
  const Ended ended = run_stages(s, by_rattle, report, team);
  const bool solved = report.status == Status::converged || report.status == Status::passed_through;
  const bool good = s.settings.iterations > 0 || (solved && has_answer(ended) &&
                                                  keeps_energy(measure_kicks(s, attempt.h, team)));
  if (good) {
    worsen(report, before);
    return ended;
  }
  report.status = before;
  ++report.scheme_fallbacks;
  Attempt by_paper = attempt;
  by_paper.predicted = false;
  return run_stages(s, by_paper, report, team);
}

}  // namespace weft
