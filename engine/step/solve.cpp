#include "engine/step/solve.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/step/motion.h"
#include "engine/step/reporting.h"
#include "engine/step/standstill.h"

namespace weft {

Strain strain_at(State& s, kernels::Vectors& x, Team& team) {
  return s.measure ? s.measure->strain(x.view(), team) : measure_strain(*s.model, x);
}

double max_strain_at(State& s, kernels::Vectors& x, Team& team) {
  return s.measure ? s.measure->max_strain(x.view(), team) : measure_strain(*s.model, x).max;
}

double penetration_at(State& s, kernels::Vectors& x) {
  if (!s.model->has_contacts()) return 0;
  return max_penetration(*s.model, *s.kernels, x.view(), s.contacts);
}

void report_errors(State& s, kernels::Vectors& x, StepReport& report, Team& team) {
  const Strain strain = strain_at(s, x, team);
  report.max_strain = strain.max;
  report.rms_strain = strain.rms;
  report.worst_constraint = strain.worst_constraint;
  report.contacts = static_cast<int>(s.contacts.count());
  report.max_penetration = penetration_at(s, x);
}

namespace {

using From = DirectSolver::From;

/// Solves that ran into contacts from beyond the margin are repeated; each round adds at least one
/// contact, in practice one round is rare and two were not seen.
constexpr int kMaxContactRounds = 16;

Status add(StepReport& report, const kernels::LoopResult& result) {
  report.visits += result.visits;
  report.corrections += result.corrections;
  return result.converged ? Status::converged : Status::iteration_limit;
}

kernels::LoopLimits limits_of(const Settings& settings, int most) {
  return {.fixed_iterations = settings.iterations,
          .max_iterations = most,
          .renew_after = settings.renew_after};
}

/// Until the commit nobody needs next_velocity.
kernels::LoopResult sweep_previewed_positions(State& s, double h, bool first,
                                              const kernels::LoopLimits& limits) {
  reference::Motion motion = reference_motion(s);
  motion.velocity = s.next_velocity.view();
  return s.reference->solve_previewed_positions(motion, h, s.contacts, first, limits);
}

/// With a start: along the directions there (scheme rattle).
kernels::LoopResult sweep_positions(State& s, double h, kernels::VectorsView start, bool first,
                                    const kernels::LoopLimits& limits, Team& team) {
  if (s.previews) return sweep_previewed_positions(s, h, first, limits);
  const auto x = s.solved.view();
  return s.reference ? s.reference->solve_positions(x, start, h, s.contacts, first, limits)
                     : s.simd->solve_positions(x, start, s.contacts, first, limits, team);
}

bool within_tolerance(State& s, Team& team) {
  return max_strain_at(s, s.solved, team) <= s.settings.tolerance &&
         penetration_at(s, s.solved) <= s.settings.contact_tolerance;
}

/// Sweeps until nothing is out of tolerance, `most` iterations are done, or none of them brings
/// anything any more. The last of them may have put right what no other was left to find so.
kernels::LoopResult sweep_on(State& s, double h, bool first, int most, Standstill& standstill,
                             Team& team) {
  if (s.settings.iterations > 0)
    return sweep_positions(s, h, {}, first, limits_of(s.settings, most), team);
  kernels::LoopResult sum;
  while (sum.iterations < most && !standstill.reached()) {
    const int part = std::min(most - sum.iterations, kPassesBetweenLooks);
    const kernels::LoopLimits limits{
        .max_iterations = part, .renew_after = standstill.in_doubt() ? 1 : s.settings.renew_after};
    count(sum, sweep_positions(s, h, {}, first && sum.iterations == 0, limits, team));
    if (sum.converged || part < kPassesBetweenLooks) break;
    standstill.look(strain_at(s, s.solved, team), penetration_at(s, s.solved));
  }
  if (!sum.converged && sum.iterations >= most) sum.converged = within_tolerance(s, team);
  return sum;
}

/// Scheme rattle, as long as sweeps bring the largest strain down: if they do not, the paper's
/// scheme is quicker than waiting.
kernels::LoopResult sweep_from_start(State& s, double h, kernels::VectorsView start, bool first,
                                     int most, Team& team) {
  constexpr int kPasses = 256;
  if (s.settings.iterations > 0) {
    return sweep_positions(s, h, start, first, limits_of(s.settings, most), team);
  }
  kernels::LoopResult sum;
  double strain = std::numeric_limits<double>::infinity();
  for (;;) {
    const kernels::LoopLimits limits{.max_iterations = std::min(most - sum.iterations, kPasses),
                                     .renew_after = s.settings.renew_after};
    count(sum, sweep_positions(s, h, start, first && sum.iterations == 0, limits, team));
    if (sum.converged || sum.iterations >= most) return sum;
    const double before = std::exchange(strain, max_strain_at(s, s.solved, team));
    if (!(strain < before)) return sum;
  }
}

/// Of a fixed number of iterations those that the direct solver has not done, where the system has
/// no solution: sweeps do them.
bool are_left(const Settings& settings, const kernels::LoopResult& done) {
  return done.iterations < settings.iterations;
}
kernels::LoopLimits left_of(const Settings& settings, const kernels::LoopResult& done) {
  kernels::LoopLimits limits = limits_of(settings, 1);
  limits.fixed_iterations -= done.iterations;
  return limits;
}

kernels::LoopResult sweep_velocities(State& s, const kernels::LoopLimits& limits, Team& team) {
  const auto x = s.solved.view(), v = s.next_velocity.view();
  return s.reference ? s.reference->correct_velocities(x, v, s.contacts, limits)
                     : s.simd->correct_velocities(x, v, s.contacts, limits, team);
}

kernels::LoopResult solve_from_start(State& s, double h, kernels::VectorsView start, bool first,
                                     int left, Team& team) {
  if (s.yarn) {
    return s.yarn->solve_positions(s.solved.view(), start, s.contacts, first, left, 1, *s.measure,
                                   team);
  }
  if (!s.direct) return sweep_from_start(s, h, start, first, left, team);
  auto result = s.direct->solve_from_start(s.solved.view(), start, s.contacts, first, left);
  if (are_left(s.settings, result)) {
    count(result, sweep_positions(s, h, start, first, left_of(s.settings, result), team));
  }
  return result;
}

/// The direct solver. Where it fails sweeps begin where it did, and take the short waves out; it
/// tries again from there, and after each failure they go on, four times as many. Half of the
/// iterations are theirs. Smaller steps are the better answer where they help: sweeps stop at the
/// tolerance, and the error that they leave is removed by the next step's solve at once, as a blow
/// (a sphere that drops on 20 x 20 particles, 4 substeps, 1 %: 10.6 J gained with sweeps, 5e-5 J
/// with halved steps).
kernels::LoopResult solve_directly(State& s, const Attempt& attempt, From from, int left,
                                   Standstill& standstill, Team& team) {
  constexpr int kFirstSweeps = 32, kMoreSweeps = 4;
  const bool may_sweep = attempt.on_failure == OnFailure::sweep;
  const bool noise_will_do = may_sweep;  // nobody is going to try a shorter step
  const auto solve = [&](From begin, int most) {
    return s.direct->solve_positions(s.solved.view(), s.contacts, begin, most, noise_will_do);
  };
  auto result = solve(from, may_sweep ? std::max(1, left / 2) : left);
  if (are_left(s.settings, result)) {
    const bool first = from == From::prediction;
    count(result, sweep_positions(s, attempt.h, {}, first, left_of(s.settings, result), team));
  }

  int sweeps = kFirstSweeps;
  for (bool first = true; result.failed && may_sweep && result.iterations < left; first = false) {
    const int most = std::min(sweeps, left - result.iterations);
    count(result, sweep_on(s, attempt.h, first, most, standstill, team));
    if (result.converged || standstill.reached() || result.iterations >= left) break;
    count(result, solve(From::sweeps, left - result.iterations));
    result.failed = !result.converged;
    sweeps = sweeps < left / kMoreSweeps ? kMoreSweeps * sweeps : left;
  }
  return result;
}

/// Yarns. If need be what answers for them, to which they leave half of the iterations: the direct
/// solver, where masses differ so much that it stands by, from the same positions; else sweeps,
/// from these or, where only iterations ran out and that is nearer, from where yarns had come to.
/// Until the commit nobody needs next_velocity: it remembers the positions.
kernels::LoopResult solve_yarns(State& s, const Attempt& attempt, From from, int left,
                                Standstill& standstill, Team& team) {
  if (!attempt.hold_taut) {
    s.yarn->release_spans();
  } else if (from == From::prediction) {
    s.yarn->hold_taut_spans(s.position.view(), s.solved.view(), team);
  }
  const bool may_be_answered = attempt.on_failure == OnFailure::sweep;
  if (may_be_answered) s.next_velocity = s.solved;
  const int most = may_be_answered ? std::max(1, left / 2) : left;
  auto result = s.yarn->solve_positions(s.solved.view(), {}, s.contacts, from != From::last_round,
                                        most, attempt.allowance, *s.measure, team);
  if (!result.failed || result.converged || !may_be_answered) return result;
  left -= result.iterations;
  if (s.direct) {
    s.solved = s.next_velocity;
    const From begin = from == From::prediction ? from : From::sweeps;
    count(result, solve_directly(s, attempt, begin, left, standstill, team));
    return result;
  }
  const bool nearer = result.iterations >= most &&
                      max_strain_at(s, s.solved, team) < max_strain_at(s, s.next_velocity, team);
  if (!nearer) s.solved = s.next_velocity;
  count(result, sweep_on(s, attempt.h, true, left, standstill, team));
  return result;
}

kernels::LoopResult solve_round(State& s, const Attempt& attempt, From from, int left,
                                Standstill& standstill, Team& team) {
  const bool first = from == From::prediction;
  if (attempt.by_rattle()) return solve_from_start(s, attempt.h, attempt.start, first, left, team);
  if (s.yarn) return solve_yarns(s, attempt, from, left, standstill, team);
  if (s.direct) return solve_directly(s, attempt, from, left, standstill, team);
  return sweep_on(s, attempt.h, first, left, standstill, team);
}

kernels::LoopResult correct_directly(State& s, bool exact, int most, Team& team) {
  auto result = s.direct->correct_velocities(s.solved.view(), s.next_velocity.view(), s.contacts,
                                             exact, most);
  if (are_left(s.settings, result)) {
    count(result, sweep_velocities(s, left_of(s.settings, result), team));
  } else if (result.failed) {
    const int left = most - result.iterations;
    count(result, sweep_velocities(s, limits_of(s.settings, left), team));
  }
  return result;
}

/// What follows the yarns judges in double; as a rule it finds nothing to do. Half of the
/// iterations are its own.
kernels::LoopResult correct_by_yarns(State& s, bool exact, int most, Team& team) {
  auto result = s.yarn->correct_velocities(s.solved.view(), s.next_velocity.view(), s.contacts,
                                           exact, most / 2, team);
  const int left = most - result.iterations;
  count(result, s.direct ? correct_directly(s, false, left, team)
                         : sweep_velocities(s, limits_of(s.settings, left), team));
  return result;
}

kernels::LoopResult solve_velocities(State& s, bool exact, int most, Team& team) {
  if (s.yarn && s.settings.iterations == 0) return correct_by_yarns(s, exact, most, team);
  return s.direct ? correct_directly(s, exact, most, team)
                  : sweep_velocities(s, limits_of(s.settings, most), team);
}

Ended end_of(const kernels::LoopResult& result, OnFailure on_failure) {
  if (!result.failed) return Ended::solved;
  const bool left =
      on_failure == OnFailure::halve || (on_failure == OnFailure::leave && !result.converged);
  return left ? Ended::gave_up : Ended::made_do;
}

}  // namespace

Trial solve_positions(State& s, const Attempt& attempt, StepReport& report, Team& team) {
  Trial trial;
  int left = attempt.most_iterations;
  for (int round = 0; round < kMaxContactRounds; ++round) {
    Standstill standstill(s.settings, attempt.stood_at);
    const From from = round == 0                      ? From::prediction
                      : trial.ended == Ended::made_do ? From::sweeps
                                                      : From::last_round;
    const auto result = solve_round(s, attempt, from, left, standstill, team);
    trial.worsen(add(report, result));
    if (!result.converged && standstill.reached()) {
      trial.worsen(Status::infeasible);
      trial.stood_at = std::max(trial.stood_at, standstill.error());
    }
    report.iterations += result.iterations;
    left -= result.iterations;
    report.direction_updates += result.direction_updates;
    trial.worsen(end_of(result, attempt.on_failure));
    if (trial.ended == Ended::gave_up) return trial;
    const bool again = s.model->has_contacts() && result.converged &&
                       add_missed_contacts(*s.model, *s.kernels, s.solved.view(),
                                           s.settings.contact_tolerance, s.contacts) > 0;
    if (!again) return trial;
  }
  trial.worsen(Status::iteration_limit);
  trial.worsen(Ended::made_do);
  return trial;
}

Status correct_velocities(State& s, const Attempt& attempt, StepReport& report, Team& team) {
  const auto result =
      solve_velocities(s, attempt.by_rattle(), attempt.most_velocity_iterations, team);
  report.velocity_iterations += result.iterations;
  return add(report, result);
}

}  // namespace weft
