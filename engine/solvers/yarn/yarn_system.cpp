/// The linear system of all yarns (kernels/simd/yarn_system.h), and its solution.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/solvers/yarn/yarn_solver.h"
#include "engine/tuning.h"

namespace weft {
namespace {

constexpr std::size_t kNumbers = 4096;  // the number of floats that a thread takes at a time
constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

void YarnSolver::linearise(Team& team) {
  linearise_yarns(team);
  singles_.linearise(base_.data(), u_.data());
}

void YarnSolver::linearise_velocities(Team& team) {
  linearise_yarns(team);
  singles_.linearise_velocities(base_.data(), u_.data());
}

void YarnSolver::linearise_yarns(Team& team) {
  for_each_block(0, layout_.blocks.size(), team,
                 [&](const simd::Yarns& yarns, std::size_t i, simd::YarnScratch* scratch) {
                   table_.yarn_linearise(yarns, layout_.blocks[i], u_.data(), scratch);
                 });
  moved_ = false;
}

double YarnSolver::read_velocities(Team& team) {
  for_each_block(0, layout_.blocks.size(), team,
                 [&](const simd::Yarns& yarns, std::size_t i, simd::YarnScratch* scratch) {
                   products_[i].worst =
                       table_.yarn_read(yarns, layout_.blocks[i], u_.data(), scratch);
                 });
  double worst = singles_.read(base_.data(), u_.data());
  if (!std::isfinite(worst)) return kInfinite;
  for (const simd::YarnProducts& p : products_) {
    if (!std::isfinite(p.worst)) return kInfinite;
    worst = std::max(worst, static_cast<double>(p.worst));
  }
  return worst;
}

YarnSolver::Products YarnSolver::precondition(double alpha, double goal, Team& team) {
  for_each_block(first_end_, layout_.blocks.size(), team,
                 [&](const simd::Yarns& yarns, std::size_t i, simd::YarnScratch*) {
                   products_[i] = table_.yarn_precondition(yarns, layout_.blocks[i],
                                                           static_cast<float>(alpha));
                 });
  const simd::YarnProducts others = singles_.precondition(alpha, goal);
  Products sum{static_cast<double>(others.product), static_cast<double>(others.worst)};
  for (std::size_t i = first_end_; i < products_.size(); ++i) {
    sum.product += static_cast<double>(products_[i].product);
    sum.worst = std::max(sum.worst, static_cast<double>(products_[i].worst));
  }
  return sum;
}

void YarnSolver::clear_push(Team& team) {
  team.for_each_part(t_.size(), kNumbers, [&](std::size_t first, std::size_t last) {
    std::fill(t_.data() + first, t_.data() + last, 0.f);
  });
}

/// Forms the right side of the reduced system, and its first preconditioned residual.
YarnSolver::Products YarnSolver::reduce(double goal, Team& team) {
  clear_push(team);
  eliminate(simd::YarnElimination::errors, team);
  pull(team);
  return precondition(-1, goal, team);
}

/// Sets t = M^-1 J^T p, with the impulses of all families but the first.
void YarnSolver::push(double beta, Team& team) {
  const auto factor = static_cast<float>(beta);
  const std::vector<std::uint32_t>& begin = layout_.family_begin;
  for (const std::size_t place : layout_.not_in_second) {
    for (std::size_t axis = 0; axis < 3; ++axis) t_[place + axis * layout_.places.stride] = 0;
  }
  for (std::size_t f = 1; f < layout_.families(); ++f) {
    const auto push = f == 1 ? table_.yarn_push_first : table_.yarn_push;
    for_each_block(begin[f], begin[f + 1], team,
                   [&](const simd::Yarns& yarns, std::size_t i, simd::YarnScratch* scratch) {
                     push(yarns, layout_.blocks[i], factor, t_.data(), scratch);
                   });
  }
  singles_.push(beta, t_.data());
}

/// Subtracts M^-1 J^T T^-1 J t of the first family from t; with errors, M^-1 J^T T^-1 (e + J t).
void YarnSolver::eliminate(simd::YarnElimination what, Team& team) {
  for_each_block(0, first_end_, team,
                 [&](const simd::Yarns& yarns, std::size_t i, simd::YarnScratch* scratch) {
                   table_.yarn_eliminate(yarns, layout_.blocks[i], t_.data(), what, scratch);
                 });
}

/// Sets q = J t for all families but the first. Returns p . q.
double YarnSolver::pull(Team& team) {
  for_each_block(first_end_, layout_.blocks.size(), team,
                 [&](const simd::Yarns& yarns, std::size_t i, simd::YarnScratch* scratch) {
                   products_[i].product =
                       table_.yarn_pull(yarns, layout_.blocks[i], t_.data(), scratch);
                 });
  double sum = singles_.pull(t_.data());
  for (std::size_t i = first_end_; i < products_.size(); ++i) {
    sum += static_cast<double>(products_[i].product);
  }
  return sum;
}

/// Subtracts M^-1 J^T lambda from u; the impulses of the first family follow from those of all
/// others.
void YarnSolver::finish(Team& team) {
  const std::vector<std::uint32_t>& begin = layout_.family_begin;
  clear_push(team);
  for (std::size_t f = 1; f < layout_.families(); ++f) {
    for_each_block(begin[f], begin[f + 1], team,
                   [&](const simd::Yarns& yarns, std::size_t i, simd::YarnScratch* scratch) {
                     table_.yarn_finish(yarns, layout_.blocks[i], t_.data(), scratch);
                   });
  }
  singles_.finish(t_.data());
  eliminate(simd::YarnElimination::last, team);
  team.for_each_part(t_.size(), kNumbers, [&](std::size_t first, std::size_t last) {
    table_.yarn_add(u_.data(), t_.data(), first, last);
  });
}

/// Preconditioned conjugate gradients on the reduced system, then u -= M^-1 J^T lambda.
/// Contradictory errors, such as those of triangles that cannot follow a step, have no solution:
/// the residual stays, and the impulses grow in the null space of the system until the errors are
/// far larger than before. So nothing is moved if the residual stalls (tuning::kSystemPatience).
bool YarnSolver::solve(double goal, double part, int max_iterations, Team& team,
                       kernels::LoopResult& result) {
  Products now = reduce(goal, team);
  const double enough = std::max(goal, part * now.worst);
  const double first = now.product;
  double beta = 0, lowest = first;
  int done = 0, since = 0;  // iterations: all, and those since the residual last fell
  while (now.worst > enough && done < max_iterations && since < tuning::kSystemPatience.most) {
    push(beta, team);
    eliminate(simd::YarnElimination::changes, team);
    const double curvature = pull(team);
    if (!(curvature > 0 && now.product > 0)) break;
    const Products next = precondition(now.product / curvature, goal, team);
    beta = next.product / now.product;
    now = next;
    ++done;
    ++since;
    if (now.product < tuning::kSystemPatience.fall * lowest) {
      lowest = now.product;
      since = 0;
    }
  }
  const bool gained = now.worst <= enough || since < tuning::kSystemPatience.most ||
                      lowest < tuning::kFarBelow * first;
  if (gained && std::isfinite(now.product)) finish(team);
  const int passes = std::max(1, done);
  const std::int64_t visits = passes * static_cast<std::int64_t>(model_.constraints.plain);
  count(passes, visits, visits, result);
  return gained;
}

bool YarnSolver::newton(double goal, int max_iterations, Team& team, kernels::LoopResult& result) {
  make_system();
  linearise(team);
  return solve(goal, tuning::kForcing, max_iterations, team, result);
}

/// Makes the linear system when it is first needed. Its memory was reserved before, and is not
/// touched until then.
void YarnSolver::make_system() {
  system_.resize(layout_.rows());
  t_.resize(u_.size());
}

}  // namespace weft
