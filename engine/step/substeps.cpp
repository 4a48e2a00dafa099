#include "engine/step/substeps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/step/choose_substeps.h"
#include "engine/step/energy.h"
#include "engine/step/measure.h"
#include "engine/step/motion.h"
#include "engine/step/pin_work.h"
#include "engine/step/project.h"
#include "engine/step/reporting.h"
#include "engine/step/substep.h"
#include "engine/step/transaction.h"

namespace weft {
namespace {

/// What the last step left within tolerance, an error e, would come back as speed, e / dt, all the
/// more in a step that is far shorter: positions are projected before it. Returns the share of what
/// yarns usually leave that may stay; 1: nothing is projected. Whole steps are compared, whatever
/// their substeps. What taut spans hang by stays. Gauss-Seidel leaves errors of up to the tolerance
/// in every step: it would not help. (Sheets of 20 x 20, 1 %, steps of 1/60 s and a part of that in
/// turns: up to a 16th nothing is gained, 5 mJ with a 64th, 13 J with a 1667th; projected,
/// nothing.)
double allowance_after_last_step(const State& s, double dt) {
  constexpr double kFarShorter = 0.125, kLeast = 0.01;
  const bool solves_exactly = s.settings.iterations == 0 && (s.yarn || s.direct);
  return solves_exactly && dt < kFarShorter * s.last_dt ? std::max(kLeast, dt / s.last_dt) : 1;
}

/// How often a substep whose solver gives up may be cut in two, and iterations of a step beyond
/// which none is any more: halves that are as hard as the whole are no answer. (A cape of 40 x 40
/// with bending edges, on a walk: frames of 1480 ms at most without that bound, 250 with it, 12.4
/// and 5.7 on average; corners, 41 to 161, come to it once, at 81 x 81 and 0.01 %.)
constexpr int kMostHalvings = 4;
constexpr std::int64_t kMostToHalve = 1500;

/// The substeps of a step.
class Substeps {
 public:
  Substeps(State& s, StepReport& report, Team& team)
      : s_(s), report_(report), team_(team), transaction_(s) {
    const bool may_halve = s.settings.iterations == 0 &&
                           s.settings.solver != Solver::gauss_seidel && s.trouble.may_halve();
    answer_ = may_halve ? Answer::halves : Answer::sweeps;
  }

  /// Returns whether all of dt was done.
  bool run(double dt, bool jumped) {
    const double allowance = allowance_after_last_step(s_, dt);
    if (allowance < 1 || ((s_.placed || jumped) && violates_constraints(s_, team_))) {
      transaction_.begin();
      record_.stood_at = project(s_, dt, allowance, report_, team_);
    }
    const int substeps = choose_substeps(dt);
    if (substeps > 1) transaction_.begin();
    for (int left = substeps; left > 0; --left) {
      const int share = share_of(report_.iterations, left);
      present_ = {.share = share,
                  .left = share,
                  .velocities_left = share_of(report_.velocity_iterations, left),
                  .to_do = dt / substeps};
      Outcome outcome;
      while ((outcome = advance(dt / substeps, 0)) == Outcome::hopeless) be_safer();
      if (outcome == Outcome::refused) return false;
    }
    transaction_.complete();
    s_.placed = false;
    s_.last_dt = report_.status == Status::converged ? dt : 0;
    s_.trouble.remember(record());
    return true;
  }

 private:
  int choose_substeps(double dt) {
    if (s_.settings.substeps != kAutomaticSubsteps) return s_.settings.substeps;
    int wanted = 1;
    timed(report_, Stage::predict, [&] { wanted = substeps_wanted(s_, dt, team_); });
    predicted_ = wanted == 1;
    return wanted;
  }

  /// Of the iterations that the step may still do after so many, for one of the substeps left: half
  /// of them, all for the last; if possible one for the solver, and one for what answers for it.
  /// (One hard substep may want nearly all: with even shares direct misses its tolerance under a
  /// sphere of 1 kg on a taut sheet, a million iterations to a step.)
  int share_of(std::int64_t done, int substeps_left) const {
    const int most = s_.settings.max_iterations;
    return static_cast<int>(
        std::max<std::int64_t>(std::min(most, 2), (most - done) / std::min(substeps_left, 2)));
  }

  /// refused: the state could not be accepted. hopeless: halving is no answer to this substep, of
  /// which nothing has been done.
  enum class Outcome : std::uint8_t { done, refused, hopeless };

  /// After a substep was hopeless: the next answer. With the last no substep is hopeless.
  void be_safer() {
    if (answer_ == Answer::halves) record_.helped = false;
    answer_ = Answer::sweeps;
  }

  /// Advances by h, in halves where the solver gives up. Where even the first of the shortest parts
  /// does not converge there is no hope in halving, and Gauss-Seidel sweeps go on for the rest of
  /// the step. What a state violates, and what sweeps leave, would come back as speed, the more the
  /// shorter the parts: parts of such a substep gain no energy. Nor are halves an answer where it
  /// is what the start violates that brought energy: it is taken out.
  Outcome advance(double h, int halvings) {
    const OnFailure on_failure = on_failure_of(halvings);
    Trial trial = attempt(h, on_failure);
    if (trial.gained && !trial.has_result() && !begins_well(h, trial)) {
      trial = attempt(h, OnFailure::sweep);
    }
    if (trial.has_result()) {
      accept(trial, h);
      return Outcome::done;
    }
    if (on_failure == OnFailure::sweep) {
      explain(s_, h, report_, team_);
      return Outcome::refused;
    }
    present_.gave_up = true;
    const bool halve =
        present_.parts > 0 || (on_failure == OnFailure::halve && begins_well(h, trial));
    return halve ? advance_in_halves(h, halvings) : Outcome::hopeless;
  }

  Outcome advance_in_halves(double h, int halvings) {
    transaction_.begin();
    ++report_.halvings;
    const Outcome first = advance(h / 2, halvings + 1);
    return first == Outcome::done ? advance(h / 2, halvings + 1) : first;
  }

  OnFailure on_failure_of(int halvings) const {
    if (present_.left <= kept_for_sweeps()) return OnFailure::sweep;  // there is no other attempt
    const bool may_halve = halvings < kMostHalvings && report_.iterations < kMostToHalve;
    if (answer_ == Answer::halves && may_halve) return OnFailure::halve;
    return answer_ != Answer::sweeps && present_.parts == 0 ? OnFailure::leave : OnFailure::sweep;
  }

  Trial attempt(double h, OnFailure on_failure) {
    const Attempt attempt{.h = h,
                          .most_iterations = most_iterations(h, on_failure),
                          .most_velocity_iterations = part_of(present_.velocities_left, h),
                          .on_failure = on_failure,
                          .hold_taut = s_.settings.iterations == 0,
                          .allowance = std::sqrt(s_.trouble.allowance()),
                          .stood_at = std::max(record_.stood_at, s_.trouble.stood_at()),
                          .predicted = std::exchange(predicted_, false)};
    const std::int64_t before = report_.iterations, of_velocities = report_.velocity_iterations;
    const Trial trial = substep(s_, attempt, report_, team_);
    present_.left -= static_cast<int>(report_.iterations - before);
    present_.velocities_left -= static_cast<int>(report_.velocity_iterations - of_velocities);
    return trial;
  }

  /// Half of a substep's iterations are for what cannot be left to another attempt, and half of
  /// what is left of them for the rest of the substep.
  int kept_for_sweeps() const { return present_.share - present_.share / 2; }
  int part_of(int left, double h) const {
    return std::max(h < present_.to_do ? left / 2 : left, 1);
  }
  int most_iterations(double h, OnFailure on_failure) const {
    const int left = present_.left;
    int most = part_of(left, h);
    if (on_failure != OnFailure::sweep) most = left - kept_for_sweeps();
    return std::max(most, 1);
  }

  void accept(const Trial& trial, double h) {
    if (trial.ended == Ended::made_do) {
      present_.gave_up = true;
      if (answer_ == Answer::halves && !trial.gained) record_.helped = false;
    }
    if (present_.gave_up) take_gained_energy(s_, h);
    add_pin_work(h);
    transaction_.accept();
    record_.stood_at = std::max(record_.stood_at, trial.stood_at);
    worsen(report_, trial.status);
    if (trial.passed_particle != kNoIndex) report_.passed_particle = trial.passed_particle;
    ++report_.substeps;
    ++present_.parts;
    present_.to_do -= h;
  }

  /// What was taken out of energy beyond it is taken out relative to the pins' own motion, so that
  /// this is the work of what was left.
  void add_pin_work(double h) {
    if (!s_.pins.moving()) return;
    timed(report_, Stage::report,
          [&] { report_.pin_work += work_of(motion_of_pins(s_, h), s_, h); });
  }

  /// What a state already violates becomes a velocity, error / h: the shorter, the worse. For
  /// direct solutions, which remove all of it at once, and where energy was gained it must be
  /// little, or little beside what the motion of h would add. (As strict with yarns, steps of
  /// corners, 81 x 81, at 1 % end in sweeps: 48 ms a frame instead of 5.) Writes over solved.
  bool begins_well(double h, const Trial& trial) {
    const double tolerance = s_.settings.tolerance;
    const double before = max_strain_at(s_, s_.position, team_);
    if (s_.settings.solver == Solver::yarn && !trial.gained) return before <= 2 * tolerance;
    if (before <= 0.5 * tolerance && !trial.gained) return true;
    predict(s_, h, team_);
    const double share = trial.gained ? 0.25 : 0.5;
    return before <= tolerance && before <= share * max_strain_at(s_, s_.solved, team_);
  }

  /// Of the whole step. Where the tolerance is looser than what yarns aim at sweeps converge, and
  /// soon.
  StepRecord record() const {
    const bool sweeps_converge = s_.yarn && s_.settings.scheme == Scheme::paper &&
                                 s_.settings.tolerance > YarnSolver::kGoal &&
                                 report_.status == Status::converged;
    StepRecord record = record_;
    record.halved = report_.halvings > 0;
    record.helped |= !sweeps_converge;
    return record;
  }

  /// What answers where the solver gives up, in the order in which a step tries them, each for all
  /// that is left of it. OnFailure is what that comes to for one attempt. A hopeless substep, of
  /// which no part has been accepted, moves on to the next.
  enum class Answer : std::uint8_t { halves, sweeps };
  /// The substep that is being done.
  struct Present {
    int share = 0;            // of the step's iterations, for all its parts together
    int left = 0;             // of its share
    int velocities_left = 0;  // the same of velocity iterations
    double to_do = 0;         // s, of it
    int parts = 0;            // done
    bool gave_up = false;     // the solver, once at least
  };

  State& s_;
  StepReport& report_;
  Team& team_;
  Transaction transaction_;
  Answer answer_ = Answer::sweeps;
  StepRecord record_;
  bool predicted_ = false;  // the first substep, before it is tried
  Present present_;
};

}  // namespace

bool run_substeps(State& s, double dt, bool jumped, StepReport& report, Team& team) {
  return Substeps(s, report, team).run(dt, jumped);
}

}  // namespace weft
