#include "engine/step.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <tuple>
#include <utility>

#include "engine/crossings.h"
#include "engine/measure.h"
#include "engine/rattle.h"
#include "engine/solvers/team.h"
#include "engine/standstill.h"
#include "kernels/reference/integrate.h"

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
  report.stage_seconds[static_cast<std::size_t>(stage)] += seconds.count();
}

/// The worse of two: the enumerators are in order of severity.
void worsen(StepReport& report, Status status) { report.status = std::max(report.status, status); }

void count(kernels::LoopResult& sum, const kernels::LoopResult& part) {
  sum.iterations += part.iterations;
  sum.direction_updates += part.direction_updates;
  sum.visits += part.visits;
  sum.corrections += part.corrections;
  sum.converged = part.converged;
}

void add(StepReport& report, const kernels::LoopResult& result) {
  report.visits += result.visits;
  report.corrections += result.corrections;
  if (!result.converged) worsen(report, Status::iteration_limit);
}

reference::Motion reference_motion(State& s) {
  reference::Motion m;
  m.particles = s.model->slots();
  m.inverse_mass = s.model->inverse_mass.data();
  m.gravity = s.model->gravity;
  if (s.force.size() > 0) m.force = s.force.view();
  m.position = s.position.view();
  m.velocity = s.velocity.view();
  m.predicted = s.predicted.view();
  m.solved = s.solved.view();
  return m;
}

simd::Motion simd_motion(State& s) {
  simd::Motion m;
  m.inverse_mass = s.model->inverse_mass.data();
  m.gravity = s.model->gravity;
  if (s.force.size() > 0) m.force = s.force.view();
  m.position = s.position.view();
  m.velocity = s.velocity.view();
  m.solved = s.solved.view();
  m.next_velocity = s.next_velocity.view();
  return m;
}

/// work(first, last) over all slots, shared out in stretches.
template <class Work>
void for_all_slots(const State& s, Team& team, Work&& work) {
  const std::size_t slots = s.model->slots();
  team.for_each((slots + kStretch - 1) / kStretch,
                [&](std::size_t i) { work(i * kStretch, std::min(slots, (i + 1) * kStretch)); });
}

void predict(State& s, double h, Team& team) {
  if (s.reference) return reference::predict(reference_motion(s), h);
  const simd::Motion motion = simd_motion(s);
  for_all_slots(s, team, [&](std::size_t first, std::size_t last) {
    s.kernels->predict(motion, h, first, last);
  });
}

void commit(State& s, double h, Team& team) {
  if (s.reference) {
    return reference::commit(reference_motion(s), h, s.next_velocity.view());
  }
  const simd::Motion motion = simd_motion(s);
  for_all_slots(s, team, [&](std::size_t first, std::size_t last) {
    s.kernels->commit(motion, h, first, last);
  });
}

kernels::Kicks measure_kicks(State& s, double h, Team& team) {
  if (s.reference) {
    return reference::measure_kicks(reference_motion(s), h, s.next_velocity.view());
  }
  const simd::Motion motion = simd_motion(s);
  for_all_slots(s, team, [&](std::size_t first, std::size_t last) {
    s.kicks[first / kStretch] = s.kernels->measure_kicks(motion, h, first, last);
  });
  kernels::Kicks sum;
  for (const kernels::Kicks& kicks : s.kicks) sum.add(kicks);
  return sum;
}

/// With a start: along the directions there (scheme rattle).
kernels::LoopResult sweep_positions(State& s, double h, kernels::VectorsView start, bool first,
                                    const LoopBudget& budget, Team& team) {
  const auto x = s.solved.view();
  return s.reference ? s.reference->solve_positions(x, start, h, s.contacts, first, budget)
                     : s.simd->solve_positions(x, start, s.contacts, first, budget, team);
}

Strain strain_at(State& s, kernels::Vectors& x, Team& team) {
  return s.simd ? s.simd->measure_strain(x.view(), team) : measure_strain(*s.model, x);
}

double penetration_at(State& s, kernels::Vectors& x) {
  if (!s.model->has_contacts()) return 0;
  return max_penetration(*s.model, *s.kernels, x.view(), s.contacts);
}

/// Sweeps until nothing is out of tolerance, `most` iterations are done, or none of them brings
/// anything any more.
kernels::LoopResult sweep_on(State& s, double h, bool first, int most, Standstill& standstill,
                             Team& team) {
  if (s.settings.iterations > 0)
    return sweep_positions(s, h, {}, first, whole_budget(s.settings), team);
  kernels::LoopResult sum;
  while (sum.iterations < most && !standstill.reached()) {
    const int part = std::min(most - sum.iterations, kPassesBetweenLooks);
    const LoopBudget budget{part, standstill.in_doubt() ? 1 : s.settings.renew_after};
    count(sum, sweep_positions(s, h, {}, first && sum.iterations == 0, budget, team));
    if (sum.converged || part < kPassesBetweenLooks) break;
    standstill.look(strain_at(s, s.solved, team), penetration_at(s, s.solved));
  }
  return sum;
}

/// Scheme rattle, as long as sweeps bring the largest strain down: if they do not, the paper's
/// scheme is quicker than waiting.
kernels::LoopResult sweep_from_start(State& s, double h, kernels::VectorsView start, bool first,
                                     int most, Team& team) {
  constexpr int kPasses = 256;
  if (s.settings.iterations > 0) {
    return sweep_positions(s, h, start, first, whole_budget(s.settings), team);
  }
  kernels::LoopResult sum;
  double strain = std::numeric_limits<double>::infinity();
  for (;;) {
    const LoopBudget budget{std::min(most - sum.iterations, kPasses), s.settings.renew_after};
    count(sum, sweep_positions(s, h, start, first && sum.iterations == 0, budget, team));
    if (sum.converged || sum.iterations >= most) return sum;
    const double before = std::exchange(strain, strain_at(s, s.solved, team).max);
    if (!(strain < before)) return sum;
  }
}

kernels::LoopResult sweep_velocities(State& s, Team& team) {
  const auto x = s.solved.view(), v = s.next_velocity.view();
  return s.reference ? s.reference->correct_velocities(x, v, s.contacts)
                     : s.simd->correct_velocities(x, v, s.contacts, team);
}

/// What a lambda for the direct solver sees, as one reference: std::function then allocates
/// nothing.
struct Answer {
  State& state;
  double h;
  Standstill& standstill;
  Team& team;
};

kernels::LoopResult solve_from_start(State& s, double h, kernels::VectorsView start, bool first,
                                     int left, Team& team) {
  if (!s.direct) return sweep_from_start(s, h, start, first, left, team);
  return s.direct->solve_from_start(s.solved.view(), start, s.contacts, first, left);
}

kernels::LoopResult solve_positions(State& s, double h, bool first, int left,
                                    Standstill& standstill, Team& team) {
  if (!s.direct) return sweep_on(s, h, first, left, standstill, team);
  const Answer answer{s, h, standstill, team};
  const auto sweeps = [&answer](bool begin, int most) {
    auto result = sweep_on(answer.state, answer.h, begin, most, answer.standstill, answer.team);
    result.converged |= answer.standstill.reached();  // nobody will find a better answer
    return result;
  };
  auto result = s.direct->solve_positions(s.solved.view(), s.contacts, first, left, sweeps);
  result.converged &= !standstill.reached();
  return result;
}

kernels::LoopResult correct_velocities(State& s, Team& team) {
  if (!s.direct) return sweep_velocities(s, team);
  const auto answer = std::tie(s, team);
  return s.direct->correct_velocities(
      s.solved.view(), s.next_velocity.view(), s.contacts,
      [&answer](bool, int) { return std::apply(sweep_velocities, answer); });
}

void solve_positions(State& s, double h, kernels::VectorsView start, StepReport& report,
                     Team& team) {
  int left = s.settings.max_iterations;
  for (int round = 0; round < kMaxContactRounds; ++round) {
    Standstill standstill;
    const bool first = round == 0;
    const auto result = start.x != nullptr ? solve_from_start(s, h, start, first, left, team)
                                           : solve_positions(s, h, first, left, standstill, team);
    add(report, result);
    if (!result.converged && standstill.reached()) worsen(report, Status::infeasible);
    report.iterations += result.iterations;
    left -= result.iterations;
    report.direction_updates += result.direction_updates;
    const bool again = s.model->has_contacts() && result.converged &&
                       add_missed_contacts(*s.model, *s.kernels, s.solved.view(),
                                           s.settings.contact_tolerance, s.contacts) > 0;
    if (!again) return;
  }
  worsen(report, Status::iteration_limit);
}

void correct_velocities(State& s, StepReport& report, Team& team) {
  const auto result = correct_velocities(s, team);
  add(report, result);
  report.velocity_iterations += result.iterations;
}

/// The next state becomes the state, if it is one.
bool accept(State& s) {
  if (!all_finite(s.solved) || !all_finite(s.next_velocity)) return false;
  std::swap(s.position, s.solved);
  std::swap(s.velocity, s.next_velocity);
  return true;
}

void report_errors(State& s, StepReport& report, Team& team) {
  const Strain strain = strain_at(s, s.position, team);
  report.max_strain = strain.max;
  report.rms_strain = strain.rms;
  report.worst_constraint = strain.worst_constraint;
  report.contacts = static_cast<int>(s.contacts.count());
  report.max_penetration = penetration_at(s, s.position);
}

/// Below this a thread has too little to do between two meetings: two gained nothing at 1,600
/// particles and 1.7 times at 10,000.
constexpr std::size_t kLeastSlotsPerThread = 1000;

int threads_worth_having(const State& s) {
  if (s.reference) return 1;
  const std::size_t most = s.model->slots() / kLeastSlotsPerThread;
  const std::size_t wanted = s.settings.threads > 0 ? static_cast<std::size_t>(s.settings.threads)
                                                    : static_cast<std::size_t>(kMaxThreads);
  return static_cast<int>(std::min(most, wanted));
}

/// accept() makes a transaction of one substep; several must remember where they began, and return
/// there unless all are done, whatever the reason.
class Transaction {
 public:
  explicit Transaction(State& s) : s_(s) {
    if (s.settings.substeps == 1) return;
    s.start_position = s.position;
    s.start_velocity = s.velocity;
  }
  ~Transaction() {
    if (accepted_ == 0 || accepted_ == s_.settings.substeps) return;
    std::swap(s_.position, s_.start_position);
    std::swap(s_.velocity, s_.start_velocity);
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  bool accept() {
    const bool accepted = weft::accept(s_);
    accepted_ += accepted;
    return accepted;
  }

 private:
  State& s_;
  int accepted_ = 0;
};

/// Of a substep that was not accepted: who left the range of numbers, and whether that would have
/// happened without any constraint.
void explain(State& s, double h, StepReport& report, Team& team) {
  const std::size_t solved =
      std::min(first_not_finite(s.solved), first_not_finite(s.next_velocity));
  predict(s, h, team);
  const std::size_t predicted = first_not_finite(s.solved);
  const bool input = predicted < s.model->slots();
  report.failed_particle = s.model->ordering.particle_at[input ? predicted : solved];
  worsen(report, input ? Status::non_finite_input : Status::non_finite);
}

void watch_crossings(State& s, StepReport& report) {
  const std::uint32_t passed = find_crossing(*s.model, s.position, s.solved);
  if (passed == kNoIndex) return;
  report.passed_particle = s.model->ordering.particle_at[passed];
  worsen(report, Status::passed_through);
}

/// With a start: by scheme rattle.
void substep(State& s, double h, kernels::VectorsView start, StepReport& report, Team& team) {
  timed(report, Stage::predict, [&] { predict(s, h, team); });
  if (s.model->has_contacts()) {
    timed(report, Stage::find_contacts,
          [&] { find_contacts(*s.model, *s.kernels, s.solved.view(), s.contacts); });
  }
  timed(report, Stage::solve_positions, [&] { solve_positions(s, h, start, report, team); });
  timed(report, Stage::commit, [&] { commit(s, h, team); });
  if (s.settings.velocity_correction) {
    timed(report, Stage::correct_velocities, [&] { correct_velocities(s, report, team); });
  }
  if (s.settings.iterations > 0 && report.status <= Status::iteration_limit) {
    report.status = Status::fixed_iterations;
  }
  if (s.model->has_contacts()) {
    timed(report, Stage::find_contacts, [&] { watch_crossings(s, report); });
  }
}

/// Until it is accepted a substep leaves position and velocity alone: it can be done again. With a
/// fixed number of iterations it is not.
void substep(State& s, double h, StepReport& report, Team& team) {
  if (s.settings.scheme == Scheme::paper) return substep(s, h, {}, report, team);
  const Status before = std::exchange(report.status, Status::converged);
  substep(s, h, s.position.view(), report, team);
  const bool good = report.status == Status::fixed_iterations ||
                    (report.status == Status::converged && keeps_energy(measure_kicks(s, h, team)));
  if (good) return worsen(report, before);
  report.status = before;
  ++report.scheme_fallbacks;
  substep(s, h, {}, report, team);
}

void run_substeps(State& s, double h, StepReport& report, Team& team) {
  Transaction transaction(s);
  for (int k = 0; k < s.settings.substeps; ++k) {
    substep(s, h, report, team);
    if (transaction.accept()) continue;
    return explain(s, h, report, team);
  }
}

}  // namespace

StepReport step(State& s, double dt) {
  StepReport report;
  Team team(threads_worth_having(s), s.meeting);
  run_substeps(s, dt / s.settings.substeps, report, team);
  if (report.status != Status::passed_through) report.passed_particle = kNoIndex;
  timed(report, Stage::report, [&] { report_errors(s, report, team); });
  return report;
}

}  // namespace weft
