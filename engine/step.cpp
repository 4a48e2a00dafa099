#include "engine/step.h"

#include <algorithm>
#include <chrono>
#include <cmath>
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

/// What is done where the chosen solver gives up: the substep is left to be done in halves, or
/// Gauss-Seidel sweeps go on from there.
enum class OnFailure : std::uint8_t { give_up, sweep };

/// One way to try a substep.
struct Attempt {
  double h = 0;
  int most_iterations = 1;
  OnFailure on_failure = OnFailure::sweep;
  kernels::VectorsView start{};  // with scheme rattle: where the directions are
};

/// Yarns; if need be, from the same positions, sweeps. Until the commit nobody needs next_velocity:
/// it remembers the positions.
kernels::LoopResult solve_yarns(State& s, double h, bool first, int left, OnFailure on_failure,
                                Standstill& standstill, Team& team) {
  const bool may_sweep = on_failure == OnFailure::sweep;
  if (may_sweep) s.next_velocity = s.solved;
  auto result = s.yarn->solve_positions(s.solved.view(), s.contacts, first, left, *s.simd, team);
  if (!result.failed || !may_sweep) return result;
  s.solved = s.next_velocity;
  const auto swept = sweep_on(s, h, true, left - result.iterations, standstill, team);
  result.iterations += swept.iterations;
  result.direction_updates += swept.direction_updates;
  result.visits += swept.visits;
  result.corrections += swept.corrections;
  result.converged = swept.converged;
  return result;
}

kernels::LoopResult solve_positions(State& s, double h, bool first, int left, OnFailure on_failure,
                                    Standstill& standstill, Team& team) {
  if (s.yarn) return solve_yarns(s, h, first, left, on_failure, standstill, team);
  if (!s.direct) return sweep_on(s, h, first, left, standstill, team);
  if (on_failure == OnFailure::give_up) {
    return s.direct->solve_positions(s.solved.view(), s.contacts, first, left, {});
  }
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

/// Returns whether the solver gave up.
bool solve_positions(State& s, const Attempt& attempt, StepReport& report, Team& team) {
  int left = attempt.most_iterations;
  for (int round = 0; round < kMaxContactRounds; ++round) {
    Standstill standstill;
    const bool first = round == 0;
    const auto result =
        attempt.start.x != nullptr
            ? solve_from_start(s, attempt.h, attempt.start, first, left, team)
            : solve_positions(s, attempt.h, first, left, attempt.on_failure, standstill, team);
    add(report, result);
    if (!result.converged && standstill.reached()) worsen(report, Status::infeasible);
    report.iterations += result.iterations;
    left -= result.iterations;
    report.direction_updates += result.direction_updates;
    const bool again = s.model->has_contacts() && result.converged &&
                       add_missed_contacts(*s.model, *s.kernels, s.solved.view(),
                                           s.settings.contact_tolerance, s.contacts) > 0;
    if (!again) return result.failed && attempt.on_failure == OnFailure::give_up;
  }
  worsen(report, Status::iteration_limit);
  return false;
}

void correct_velocities(State& s, StepReport& report, Team& team) {
  const auto result = correct_velocities(s, team);
  add(report, result);
  report.velocity_iterations += result.iterations;
}

bool is_finite(const State& s) { return all_finite(s.solved) && all_finite(s.next_velocity); }

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

/// accept() makes a transaction of one substep; a step that changes the state before it has done
/// all must remember where it began, and returns there whatever the reason.
class Transaction {
 public:
  explicit Transaction(State& s) : s_(s) {}
  ~Transaction() {
    if (!begun_ || complete_) return;
    std::swap(s_.position, s_.start_position);
    std::swap(s_.velocity, s_.start_velocity);
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  /// The state is about to change.
  void begin() {
    if (begun_) return;
    s_.start_position = s_.position;
    s_.start_velocity = s_.velocity;
    begun_ = true;
  }

  /// The substep becomes the state; the last one ends the step.
  void accept(bool last) {
    if (!last) begin();
    std::swap(s_.position, s_.solved);
    std::swap(s_.velocity, s_.next_velocity);
    complete_ = last;
  }

 private:
  State& s_;
  bool begun_ = false, complete_ = false;
};

/// The pins under way: whatever becomes of the step, they stand in the end where they were sent.
class Travel {
 public:
  Travel(State& s, double dt) : s_(s), jumped_(s.pins.depart(dt, s.position, s.velocity)) {}
  ~Travel() { s_.pins.stop(arrived_, s_.position, s_.velocity); }
  Travel(const Travel&) = delete;
  Travel& operator=(const Travel&) = delete;

  bool jumped() const { return jumped_; }
  void arrive() { arrived_ = true; }

 private:
  State& s_;
  const bool jumped_;
  bool arrived_ = false;
};

/// With a fixed number of iterations nobody asks.
bool violates_constraints(State& s, Team& team) {
  return s.settings.iterations == 0 &&
         (strain_at(s, s.position, team).max > s.settings.tolerance ||
          penetration_at(s, s.position) > s.settings.contact_tolerance);
}

void find_contacts(State& s, StepReport& report) {
  if (!s.model->has_contacts()) return;
  timed(report, Stage::find_contacts,
        [&] { find_contacts(*s.model, *s.kernels, s.solved.view(), s.contacts); });
}

/// Moves the positions onto the constraints and leaves the velocities: the error of a start would
/// become a velocity of error / h. What cannot be put right with half of the iterations that a
/// substep may take is left to the step, and to its status.
void project(State& s, double h, StepReport& report, Team& team) {
  const Status before = report.status;
  s.solved = s.position;
  find_contacts(s, report);
  const Attempt attempt{h, std::max(1, s.settings.max_iterations / 2), OnFailure::sweep};
  timed(report, Stage::solve_positions, [&] { solve_positions(s, attempt, report, team); });
  if (all_finite(s.solved)) s.position = s.solved;
  report.status = before;
}

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

/// Returns whether the solver gave up; then there is no next state.
bool substep(State& s, const Attempt& attempt, StepReport& report, Team& team) {
  const double h = attempt.h;
  timed(report, Stage::predict, [&] { predict(s, h, team); });
  find_contacts(s, report);
  bool gave_up = false;
  timed(report, Stage::solve_positions,
        [&] { gave_up = solve_positions(s, attempt, report, team); });
  if (gave_up) return true;
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
  return false;
}

/// Until it is accepted a substep leaves position and velocity alone: it can be done again. With a
/// fixed number of iterations it is not.
bool substep_of_scheme(State& s, const Attempt& attempt, StepReport& report, Team& team) {
  if (s.settings.scheme == Scheme::paper) return substep(s, attempt, report, team);
  const Status before = std::exchange(report.status, Status::converged);
  Attempt by_rattle = attempt;
  by_rattle.start = s.position.view();
  const bool gave_up = substep(s, by_rattle, report, team);
  const bool good = report.status == Status::fixed_iterations ||
                    (report.status == Status::converged && !gave_up &&
                     keeps_energy(measure_kicks(s, attempt.h, team)));
  if (good) {
    worsen(report, before);
    return false;
  }
  report.status = before;
  ++report.scheme_fallbacks;
  return substep(s, attempt, report, team);
}

/// How the largest strain after a step without constraints decides about the substeps: a quarter of
/// it for twice as many.
constexpr double kMostBend = 0.04;
constexpr int kMostSubsteps = 256;

/// As many as the motion wants: see kMostBend.
int choose_substeps(State& s, double dt, Team& team) {
  if (s.settings.substeps != kAutomaticSubsteps) return s.settings.substeps;
  predict(s, dt, team);
  const double wanted = std::ceil(std::sqrt(strain_at(s, s.solved, team).max / kMostBend));
  return wanted < kMostSubsteps ? std::max(1, static_cast<int>(wanted)) : kMostSubsteps;
}

/// How often a substep whose solver gives up may be cut in two.
constexpr int kMostHalvings = 4;

/// The substeps of a step.
class Substeps {
 public:
  Substeps(State& s, StepReport& report, Team& team)
      : s_(s), report_(report), team_(team), transaction_(s) {
    halving_helps_ = s.settings.iterations == 0 && s.settings.solver != Solver::gauss_seidel;
  }

  /// Returns whether all of dt was done.
  bool run(double dt, bool jumped) {
    if ((s_.placed || jumped) && violates_constraints(s_, team_)) {
      transaction_.begin();
      project(s_, dt, report_, team_);
    }
    const int substeps = choose_substeps(s_, dt, team_);
    for (int k = 1; k <= substeps; ++k) {
      left_ = s_.settings.max_iterations;
      parts_ = 0;
      Outcome outcome = advance(dt / substeps, 0, k == substeps);
      if (outcome == Outcome::hopeless) {
        halving_helps_ = false;
        outcome = advance(dt / substeps, 0, k == substeps);
      }
      if (outcome == Outcome::refused) return false;
    }
    s_.placed = false;
    return true;
  }

 private:
  /// refused: the state could not be accepted. hopeless: halving is no answer to this substep, of
  /// which nothing has been done.
  enum class Outcome : std::uint8_t { done, refused, hopeless };

  /// Advances by h, in halves where the solver gives up. Where even the first of the shortest parts
  /// does not converge there is no hope in halving, and Gauss-Seidel sweeps go on for the rest of
  /// the step.
  Outcome advance(double h, int halvings, bool last) {
    const Status before = report_.status;
    const bool may_halve = halving_helps_ && halvings < kMostHalvings && left_ > 0;
    const bool may_give_up = may_halve || (halving_helps_ && parts_ == 0);
    const int iterations = report_.iterations;
    const Attempt attempt{h, std::max(left_, 1),
                          may_give_up ? OnFailure::give_up : OnFailure::sweep};
    const bool gave_up = substep_of_scheme(s_, attempt, report_, team_);
    left_ -= report_.iterations - iterations;
    const bool finite = !gave_up && is_finite(s_);
    if (may_give_up && !finite) {
      report_.status = before;
      if (parts_ == 0 && !(may_halve && begins_well(h))) return Outcome::hopeless;
      ++report_.halvings;
      const Outcome first = advance(h / 2, halvings + 1, false);
      return first == Outcome::done ? advance(h / 2, halvings + 1, last) : first;
    }
    if (!finite) {
      explain(s_, h, report_, team_);
      return Outcome::refused;
    }
    transaction_.accept(last);
    ++report_.substeps;
    ++parts_;
    return Outcome::done;
  }

  /// What a state already violates becomes a velocity, error / h: the shorter, the worse. For
  /// direct solutions, which remove all of it at once, it must be little, or little beside what the
  /// motion of h would add. (As strict with yarns, steps of corners, 81 x 81, at 1 % end in sweeps:
  /// 48 ms a frame instead of 5.)
  bool begins_well(double h) {
    const double tolerance = s_.settings.tolerance;
    const double before = strain_at(s_, s_.position, team_).max;
    if (s_.settings.solver == Solver::yarn) return before <= 2 * tolerance;
    if (before <= 0.5 * tolerance) return true;
    predict(s_, h, team_);
    return before <= tolerance && before <= 0.5 * strain_at(s_, s_.solved, team_).max;
  }

  State& s_;
  StepReport& report_;
  Team& team_;
  Transaction transaction_;
  bool halving_helps_ = false;
  int left_ = 0;   // iterations, of a substep and its parts together
  int parts_ = 0;  // of the present substep, done
};

}  // namespace

StepReport step(State& s, double dt) {
  StepReport report;
  Team team(threads_worth_having(s), s.meeting);
  {
    Travel travel(s, dt);
    if (Substeps(s, report, team).run(dt, travel.jumped())) travel.arrive();
  }
  if (report.status != Status::passed_through) report.passed_particle = kNoIndex;
  timed(report, Stage::report, [&] { report_errors(s, report, team); });
  return report;
}

}  // namespace weft
