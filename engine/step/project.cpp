#include "engine/step/project.h"

#include <algorithm>

#include "engine/step/measure.h"
#include "engine/step/motion.h"
#include "engine/step/reporting.h"
#include "engine/step/solve.h"
#include "engine/step/substep.h"

namespace weft {

bool violates_constraints(State& s, Team& team) {
  return s.settings.iterations == 0 &&
         (max_strain_at(s, s.position, team) > s.settings.tolerance ||
          penetration_at(s, s.position) > s.settings.contact_tolerance);
}

double project(State& s, double h, double allowance, StepReport& report, Team& team) {
  s.solved = s.position;
  find_contacts(s, report);
  const Attempt attempt{.h = h,
                        .most_iterations = std::max(1, s.settings.max_iterations / 2),
                        .on_failure = OnFailure::sweep,
                        .hold_taut = allowance < 1,
                        .allowance = allowance,
                        .stood_at = s.trouble.stood_at()};
  Trial trial;
  timed(report, Stage::solve_positions, [&] { trial = solve_positions(s, attempt, report, team); });
  if (all_finite(s.solved)) s.position = s.solved;
  return trial.stood_at;
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
