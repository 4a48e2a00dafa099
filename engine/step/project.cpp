#include "engine/step/project.h"

#include <algorithm>
#include <cstdint>

#include "engine/measure/state_measure.h"
#include "engine/step/exact_substep.h"
#include "engine/step/motion.h"
#include "engine/step/reporting.h"
#include "engine/step/small_step.h"
#include "engine/tuning.h"

namespace weft {
namespace {

/// Springs that are out of shape are no error.
double largest_rigid_strain(const State& s) {
  const ConstraintStore& store = s.model->constraints;
  double most = 0;
  for (std::size_t c = 0; c < store.size(); ++c) {
    if (store.compliance[c] == 0) most = std::max(most, strain_of(*s.model, s.position, c));
  }
  return most;
}

bool is_out_of_tolerance(State& s, Team& team) {
  if (s.anchors.largest_excess(s.model->anchors, s.position, false) > s.settings.contact_tolerance)
    return true;
  if (!s.model->constraints.has_springs())
    return s.measure->error(s.position.view(), nullptr, s.contacts, team) > 1;
  return largest_rigid_strain(s) > s.settings.tolerance ||
         s.measure->penetration(s.position.view(), s.contacts) > s.settings.contact_tolerance;
}

}  // namespace

bool needs_projection(State& s, Team& team) {
  if (s.settings.iterations > 0) return false;
  return (s.placed || s.displaced) && is_out_of_tolerance(s, team);
}

void project(State& s, double dt, StepReport& report, Team& team) {
  const int most = (s.settings.max_iterations + 1) / 2;
  const auto by_small_steps = [&] {
    const auto left = static_cast<int>(std::max<std::int64_t>(0, most - report.iterations));
    project_by_small_steps(s, dt, {.positions = left}, report, team);
  };
  s.solved = s.position;
  find_contacts(s, report);
  timed(report, Stage::solve_positions, [&] {
    if (s.settings.solver == Solver::small_steps) return by_small_steps();
    if (s.laws) s.laws->begin(*s.model, s.position.view(), 0, s.settings.tolerance);
    const PositionTask task{.x = s.solved.view(),
                            .start = s.position.view(),
                            .contacts = s.contacts,
                            .h = dt,
                            .max_iterations = s.small_steps ? std::max(1, most / 2) : most,
                            .laws = s.laws ? &*s.laws : nullptr};
    const auto result = solve_positions(s, *s.solver, task, report, team);
    if (!result.converged && s.small_steps) {
      s.solved = s.position;
      by_small_steps();
    }
  });
  if (all_finite(s.solved)) s.position = s.solved;
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

void report_errors(State& s, kernels::Vectors& x, bool ends, StepReport& report, Team& team) {
  Strain strain = s.measure->strain(x.view(), team);
  if (!s.model->constraints.has_springs())
    report.max_error = strain.max;
  else if (!committed(report.status))
    report.max_error = largest_rigid_strain(s);
  add_membrane_strain(*s.model, x, strain);
  report.max_strain = strain.max;
  report.rms_strain = strain.rms;
  report.worst_constraint = strain.worst_constraint;
  report.max_shear = strain.max_shear;
  report.worst_element = strain.worst_element;
  report.contacts = static_cast<int>(s.contacts.count());
  report.max_penetration = s.measure->penetration(x.view(), s.contacts);
  report.max_anchor_error = s.anchors.largest_excess(s.model->anchors, x, ends);
}

}  // namespace weft
