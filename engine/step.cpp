#include "engine/step.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "engine/contacts.h"
#include "engine/measure.h"
#include "kernels/reference/integrate.h"
#include "kernels/reference/relax.h"

namespace weft {
namespace {

/// Solves that ran into contacts from beyond the margin are repeated; each round adds at least one
/// contact, in practice one round is rare and two were not seen.
constexpr int kMaxContactRounds = 16;

template <class Work>
void timed(StepReport& report, Stage stage, Work&& work) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  work();
  const std::chrono::duration<double> seconds = Clock::now() - start;
  report.stage_seconds[static_cast<std::size_t>(stage)] = seconds.count();
}

reference::Motion motion(State& s) {
  reference::Motion m;
  m.particles = s.model->particles;
  m.inverse_mass = s.model->inverse_mass.data();
  m.gravity = s.model->gravity;
  if (s.force.size() > 0) m.force = s.force.view();
  m.position = s.position.view();
  m.velocity = s.velocity.view();
  m.predicted = s.predicted.view();
  m.solved = s.solved.view();
  return m;
}

reference::Method method(const Settings& settings, int iterations_done) {
  return {.anticipate = settings.anticipate,
          .skip = settings.skip,
          .frozen_directions = settings.directions == Directions::frozen,
          .fixed_iterations = settings.iterations,
          .max_iterations = settings.max_iterations - iterations_done};
}

/// The worse of two: the enumerators are in order of severity.
void worsen(StepReport& report, Status status) { report.status = std::max(report.status, status); }

void add(StepReport& report, const reference::LoopResult& result) {
  report.visits += result.visits;
  report.corrections += result.corrections;
  if (!result.converged) worsen(report, Status::iteration_limit);
}

void solve_positions(State& s, double h, StepReport& report) {
  std::fill(s.constraints.impulse.begin(), s.constraints.impulse.end(), 0.0);
  for (int round = 0; round < kMaxContactRounds; ++round) {
    const auto result =
        reference::relax_positions(s.position_problem(h), s.model->topology(), s.contact_lists(),
                                   s.workspace(), method(s.settings, report.iterations));
    add(report, result);
    report.iterations += result.iterations;
    report.direction_updates += result.direction_updates;
    const bool again = s.model->has_contacts() && result.converged && add_missed_contacts(s) > 0;
    if (!again) return;
  }
  worsen(report, Status::iteration_limit);
}

/// Ropes and contacts take part where they are taut or touch; slack ones get an endless tolerance.
void choose_velocity_tolerances(State& s, const reference::Relaxation& r) {
  const double tolerance = s.settings.iterations == 0 ? s.settings.velocity_tolerance : 0;
  for (std::size_t c = 0; c < r.count; ++c) {
    bool active = true;
    if (c >= r.bilateral) {
      const double target =
          c < r.pulling ? s.model->constraints.rest_length[c] : s.constraints.target[c];
      const double e = length(s.next_position[r.a[c]] - s.next_position[r.b[c]]) - target;
      active = c < r.pulling ? e >= -s.constraints.tolerance[c] : e <= s.constraints.tolerance[c];
    }
    s.constraints.velocity_tolerance[c] =
        active ? tolerance : std::numeric_limits<double>::infinity();
  }
}

void correct_velocities(State& s, StepReport& report) {
  const reference::Relaxation problem = s.velocity_problem();
  reference::renew_all_directions(s.position_problem(1), s.next_position.view());
  choose_velocity_tolerances(s, problem);
  std::fill(s.constraints.impulse.begin(), s.constraints.impulse.end(), 0.0);
  const auto result = reference::relax_velocities(problem, s.model->topology(), s.contact_lists(),
                                                  s.workspace(), method(s.settings, 0));
  add(report, result);
  report.velocity_iterations += result.iterations;
}

/// The next state becomes the state, if it is one.
bool accept(State& s) {
  if (!all_finite(s.next_position) || !all_finite(s.next_velocity)) return false;
  std::swap(s.position, s.next_position);
  std::swap(s.velocity, s.next_velocity);
  return true;
}

void report_errors(const State& s, StepReport& report) {
  const Strain strain = measure_strain(*s.model, s.position);
  report.max_strain = strain.max;
  report.rms_strain = strain.rms;
  report.worst_constraint = strain.worst_constraint;
  report.contacts = static_cast<int>(s.contacts.count);
  report.max_penetration = max_penetration(*s.model, s.position);
}

}  // namespace

StepReport step(State& s, double h) {
  StepReport report;
  timed(report, Stage::predict, [&] { reference::predict(motion(s), h); });
  if (s.model->has_contacts()) timed(report, Stage::find_contacts, [&] { find_contacts(s); });
  timed(report, Stage::solve_positions, [&] { solve_positions(s, h, report); });
  timed(report, Stage::commit,
        [&] { reference::commit(motion(s), h, s.next_position.view(), s.next_velocity.view()); });
  if (s.settings.velocity_correction) {
    timed(report, Stage::correct_velocities, [&] { correct_velocities(s, report); });
  }
  if (s.settings.iterations > 0) report.status = Status::fixed_iterations;
  if (!accept(s)) report.status = Status::non_finite;
  timed(report, Stage::report, [&] { report_errors(s, report); });
  return report;
}

}  // namespace weft
