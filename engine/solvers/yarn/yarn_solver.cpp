#include "engine/solvers/yarn/yarn_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/bytes_of.h"
#include "engine/solvers/stall.h"
#include "engine/solvers/yarn/yarn_layout.h"
#include "engine/tuning.h"

namespace weft {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

/// The measured errors: the largest strain, and the largest error of contacts and slack ropes in
/// units of their tolerance.
struct Errors {
  double strain, violation;
};

}  // namespace

YarnSolver::YarnSolver(const Model& model, const Settings& settings, const simd::Table& table,
                       SimdMeasure& measure)
    : model_(model),
      layout_(model.yarns()),
      settings_(settings),
      usual_(std::min(settings.tolerance, tuning::kYarnGoal)),
      table_(table),
      measure_(measure),
      base_step_(layout_.rows()),
      base_(layout_.places.floats),
      u_(layout_.places.floats),
      first_end_(layout_.families() > 0 ? layout_.family_begin[1] : 0),
      products_(layout_.blocks.size()),
      solves_(layout_.blocks.size()),
      stubborn_(layout_.blocks.size()),
      singles_(model, settings),
      spans_(layout_, usual_, settings.tolerance, !model.has_spheres()) {
  const std::size_t wanted =
      settings.threads > 0 ? static_cast<std::size_t>(settings.threads) : kMostYarnShares;
  if (settings.scheme == Scheme::rattle) start_.resize(layout_.rows());
  if (model.constraints.has_springs()) springs_.resize(layout_.rows());
  system_.reserve(layout_.rows());
  t_.reserve(u_.size());
  scratch_.resize(layout_.scratch_rows() * std::min(wanted, kMostYarnShares));
}

simd::Yarns YarnSolver::yarns() {
  return {.kind = spans_.holds() ? spans_.kind() : layout_.kind.data(),
          .kinds = spans_.holds() ? spans_.kinds() : layout_.kinds.data(),
          .system = system_.data(),
          .slot = layout_.slot.data(),
          .patch = layout_.patches.data(),
          .start = from_start_ ? start_.data() : nullptr,
          .velocities = velocities_,
          .base = base_.data(),
          .base_step = base_step_.data(),
          .cell = static_cast<float>(cell_),
          .moved = moved_,
          .from_memory = layout_.from_memory(),
          .springs = springs_.empty() ? nullptr : springs_.data()};
}

void YarnSolver::split(kernels::VectorsView x, double cell, Team& team) {
  layout_.places.clear(u_.data());
  team.for_each_part(model_.slots(), kStretch, [&](std::size_t first, std::size_t last) {
    layout_.places.split(table_, x, cell, first, last, base_.data(), u_.data());
  });
  cell_ = cell;
  moved_ = true;
}

void YarnSolver::keep_start(kernels::VectorsView start, Team& team) {
  split(start, team);
  from_start_ = true;
  for_each_block(0, layout_.blocks.size(), team,
                 [&](const simd::Yarns& yarns, std::size_t i, simd::YarnScratch* scratch) {
                   table_.yarn_keep_start(yarns, layout_.blocks[i], u_.data(), scratch);
                 });
  singles_.keep_start(base_.data(), u_.data());
}

void YarnSolver::join(kernels::VectorsView x, Team& team) {
  team.for_each_part(model_.slots(), kStretch,
                     [&](std::size_t first, std::size_t last) { join(x, first, last); });
}

void YarnSolver::join(kernels::VectorsView x, std::size_t first, std::size_t last) {
  layout_.places.join(table_, x, first, last, base_.data(), u_.data());
}

/// Solves a block until its strain is at most `enough`. A solve turns constraints, which leaves an
/// error of second order in the angle. A block that takes too many solves is solved once in each
/// sweep until the next substep. Returns the number of solves, 0 if the block needed none.
std::uint32_t YarnSolver::solve_block(const simd::Yarns& yarns, std::size_t i, double enough,
                                      simd::YarnScratch* scratch) {
  const simd::YarnBlock& block = layout_.blocks[i];
  if (enough == kNoBound) {
    table_.yarn_sweep(yarns, block, u_.data(), scratch);
    return 1;
  }
  const simd::Swept swept =
      table_.yarn_sweep_watched(yarns, block, u_.data(), scratch, static_cast<float>(enough),
                                stubborn_[i] ? 1 : tuning::kMostBlockSolves);
  if (!swept.within && swept.solves == tuning::kMostBlockSolves) stubborn_[i] = 1;
  return swept.solves;
}

void YarnSolver::sweep(double enough, Team& team, kernels::LoopResult& result) {
  for_each_family(team, [&](const simd::Yarns& yarns, std::size_t i, simd::YarnScratch* scratch) {
    solves_[i] = solve_block(yarns, i, enough, scratch);
  });
  moved_ = false;  // a pass reads the base of every block, corrected or not
  singles_.relax(base_.data(), u_.data());
  std::int64_t visits = 0, corrections = 0;
  for (std::size_t i = 0; i < solves_.size(); ++i) {
    visits += std::int64_t{std::max(1u, solves_[i])} * layout_.links[i];
    corrections += std::int64_t{solves_[i]} * layout_.links[i];
  }
  count(1, visits, corrections, result);
}

/// The arguments count constraints in yarns; single constraints are visited in every pass.
void YarnSolver::count(int passes, std::int64_t visits, std::int64_t corrections,
                       kernels::LoopResult& result) const {
  const std::int64_t others = passes * static_cast<std::int64_t>(singles_.count());
  result.iterations += passes;
  ++result.direction_updates;
  result.visits += visits + others;
  result.corrections += corrections + others;
}

/// More than one system is needed only where one-sided constraints begin or cease to act, or where
/// the rounding of floats left an error.
kernels::LoopResult YarnSolver::correct_velocities(const VelocityTask& task, Team& team) {
  if (settings_.iterations > 0) return {};  // these are sweeps of positions
  kernels::LoopResult result;
  from_start_ = false;
  velocities_ = true;
  make_system();
  singles_.start(task.contacts, nullptr, true);
  split(task.x, team);
  linearise_velocities(team);
  split(task.v, 0, team);
  const double tolerated = tuning::kSystemShare * settings_.velocity_tolerance;
  double goal = tolerated;
  Stall stall(tuning::kShortPatience);
  for (bool solved = false;; solved = true) {
    const double worst = read_velocities(team);
    if (task.exact && !solved) goal = std::min(goal, tuning::kExactVelocity * worst);
    result.converged = worst <= tolerated;
    const int left = task.max_iterations - result.iterations;
    const bool enough = worst <= goal || (result.converged && solved);
    if (enough || left <= 0 || !std::isfinite(worst) || stall.has_stalled(worst)) break;
    if (!solve(goal, 0, std::min(tuning::kMostSystemIterations, left), team, result)) break;
  }
  result.converged = result.converged && loses_energy(task.v);
  if (result.converged) join(task.v, team);
  result.converged = false;  // the caller measures convergence in double
  return result;
}

/// Whether base + u has no more kinetic energy than v. A projection never adds energy, nor do
/// conjugate gradients on their way to it; but clamped impulses of linearly dependent one-sided
/// constraints may add any amount.
bool YarnSolver::loses_energy(kernels::VectorsView v) const {
  constexpr double kRounding = 1e-6;
  double before = 0, after = 0;
  for (std::size_t i = 0; i < model_.slots(); ++i) {
    if (model_.inverse_mass[i] == 0) continue;
    const std::size_t place = layout_.places.of(static_cast<std::uint32_t>(i));
    const auto axis = [&](std::size_t k) {
      return static_cast<double>(base_[place + k * layout_.places.stride]) +
             static_cast<double>(u_[place + k * layout_.places.stride]);
    };
    const kernels::Vector now{axis(0), axis(1), axis(2)};
    before += model_.mass[i] * kernels::dot(v[i], v[i]);
    after += model_.mass[i] * kernels::dot(now, now);
  }
  return after <= (1 + kRounding) * before;
}

/// Inverse masses are in units of 1 / lightest, and so are softness and impulses.
void YarnSolver::take_laws(const SpringLaws& laws, bool first_round) {
  for (std::size_t i = 0; i < layout_.constraint.size(); ++i) {
    const std::uint32_t c = layout_.constraint[i];
    if (c == kNoIndex) continue;
    simd::YarnSpringRow& row = springs_[i / kernels::kLanes];
    const std::size_t lane = i % kernels::kLanes;
    row.softness[lane] = static_cast<float>(laws.softness[c] * layout_.lightest);
    row.shift[lane] = static_cast<float>(laws.target[c] - model_.constraints.rest_length[c]);
    if (first_round) row.sum[lane] = 0;
  }
}

void YarnSolver::keep_multipliers(SpringLaws& laws) const {
  for (std::size_t i = 0; i < layout_.constraint.size(); ++i) {
    const std::uint32_t c = layout_.constraint[i];
    if (c == kNoIndex) continue;
    const float sum = springs_[i / kernels::kLanes].sum[i % kernels::kLanes];
    laws.multiplier[c] = static_cast<double>(sum) * layout_.lightest;
  }
  singles_.keep_multipliers(laws);
}

void YarnSolver::begin(const PositionTask& task, Team& team) {
  from_start_ = false;
  velocities_ = false;
  singles_.start(task.contacts, task.laws, task.first_round);
  if (task.laws != nullptr) take_laws(*task.laws, task.first_round);
  if (task.along_start) {
    spans_.release();
    keep_start(task.start, team);
  } else if (task.first_round && settings_.iterations == 0) {
    spans_.hold(task.start, task.x, team);
  }
  std::ranges::fill(stubborn_, std::uint8_t{0});
  split(task.x, team);
}

/// With scheme rattle every block is solved once in a sweep: along the directions at the start
/// further solves do not converge, and what a block that is left alone keeps appears as a gain of
/// energy.
YarnSolver::Aim YarnSolver::aim() const {
  const bool rattle = settings_.scheme == Scheme::rattle;
  const double wanted = spans_.holds() ? spans_.may_leave() : usual_;
  const double goal = rattle && !spans_.holds() ? std::min(wanted, tuning::kRattleGoal) : wanted;
  const double left = spans_.holds() ? spans_.solver_may_leave() : goal;
  const double block = tuning::kBlockShare * left;
  return {wanted, goal, left, rattle || block < tuning::kLeastSeen ? kNoBound : block};
}

/// Whether the result of a Newton step may be taken without the sweep that follows it. The sweep
/// makes the result smoother, but in cloth that is carried fast it may undo what the step has
/// reached, each time. The sweep is always kept where taut spans are held or something touches a
/// sphere, and with springs, whose impulses it has changed.
bool YarnSolver::may_take_newton(const SphereContacts& contacts) const {
  return !from_start_ && !spans_.holds() && contacts.count() == 0 && springs_.empty();
}

kernels::LoopResult YarnSolver::sweep_so_often(const PositionTask& task, Team& team) {
  kernels::LoopResult result;
  while (result.iterations < settings_.iterations) sweep(kNoBound, team, result);
  join(task.x, team);
  if (task.laws != nullptr) keep_multipliers(*task.laws);
  return result;
}

kernels::LoopResult YarnSolver::solve_positions(const PositionTask& task, Team& team) {
  const kernels::VectorsView x = task.x;
  const int max_iterations = task.max_iterations;
  begin(task, team);
  if (settings_.iterations > 0) return sweep_so_often(task, team);
  kernels::LoopResult result;
  const Aim aim = this->aim();
  Stall stall(from_start_ ? tuning::kShortPatience : tuning::kYarnPatience);
  const auto measured = [&] {
    if (task.laws != nullptr) {
      join(x, team);
      keep_multipliers(*task.laws);
      const double left = largest_violation(*task.laws, model_.constraints, x);
      return Errors{settings_.tolerance * left, singles_.violation(base_.data(), u_.data())};
    }
    const double strain = measure_.max_strain(
        x, team, [&](std::size_t first, std::size_t last) { join(x, first, last); });
    return Errors{strain, singles_.violation(base_.data(), u_.data())};
  };
  double before = kNoBound;
  int sweeps = 1;                 // since the last measurement
  bool newton_converged = false;  // a Newton step reached the goal; t_ is its result
  sweep(aim.block, team, result);
  for (;;) {
    const auto [strain, violation] = measured();
    const bool singles_within = violation <= 1;
    result.converged = strain <= settings_.tolerance && singles_within;
    if (strain <= aim.goal && singles_within) return result;
    if (newton_converged) {
      std::ranges::copy(t_, u_.begin());
      join(x, team);
      result.converged = true;
      return result;
    }
    if (result.iterations >= max_iterations) {
      result.failed = !result.converged;
      return result;
    }
    const double error = std::max(strain / aim.goal, violation);
    if (!std::isfinite(error) || stall.has_stalled(error)) {
      result.failed = !(from_start_ ? result.converged : strain <= aim.wanted && singles_within);
      return result;
    }
    const double fall = sweeps == 1 ? strain / before : std::sqrt(strain / before);
    const int left = max_iterations - result.iterations - 1;  // without the sweep that follows
    sweeps = 1;
    if (left > 0 && strain < tuning::kNewtonStrain && fall > tuning::kSlowSweep) {
      split(x, team);
      if (!newton(tuning::kSystemShare * aim.left, std::min(tuning::kMostSystemIterations, left),
                  team, result)) {
        result.failed = !result.converged;
        return result;
      }
      if (may_take_newton(task.contacts)) {
        const Errors after = measured();
        newton_converged = after.strain <= aim.goal && after.violation <= 1;
        if (newton_converged) std::ranges::copy(u_, t_.begin());
      }
    } else if (left > 0 && fall < 1 && fall * strain > tuning::kFarFromGoal * aim.goal) {
      sweep(aim.block, team, result);
      sweeps = 2;
    }
    sweep(aim.block, team, result);
    before = strain;
  }
}

std::size_t YarnSolver::bytes() const {
  return bytes_of(springs_) + bytes_of(base_step_) + bytes_of(start_) + bytes_of(system_) +
         bytes_of(scratch_) + bytes_of(base_) + bytes_of(u_) + bytes_of(t_) + bytes_of(products_) +
         bytes_of(solves_) + bytes_of(stubborn_) + singles_.bytes() + spans_.bytes();
}

}  // namespace weft
