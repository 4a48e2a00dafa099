#include "engine/solvers/small_steps/bending_system.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/bytes_of.h"

namespace weft {
namespace {

constexpr std::size_t kPart = 256;       // slots that a sum goes over at a time
constexpr std::size_t kMostFactors = 3;  // that are kept
constexpr double kFactorsPerOctave = 4;  // of the inertia

}  // namespace

BendingSystem::BendingSystem(const BendingRows& rows, const simd::Table& table)
    : rows_(rows), table_(table) {
  for (auto* vector : {&x_, &residual_, &direction_, &product_, &z_})
    vector->resize(4 * rows.slots());
  sums_.resize((rows.slots() + kPart - 1) / kPart);
  reciprocal_.resize(rows.slots());
  made_.reserve(kMostFactors);
}

simd::BendingGradients BendingSystem::gradients() {
  return {x_.data(), residual_.data(), direction_.data(), product_.data(), reciprocal_.data()};
}

/// Of what work(first, last) returns for the slots of each range, in one order.
template <class Work>
double BendingSystem::sum(Team& team, Work&& work) const {
  team.for_each_part(rows_.slots(), kPart, [&](std::size_t first, std::size_t last) {
    sums_[first / kPart] = work(first, last);
  });
  return std::accumulate(sums_.begin(), sums_.end(), 0.0);
}

void BendingSystem::prepare_diagonal(double inertia, double stiffness) {
  if (is_prepared(BendingMethod::diagonal, inertia, stiffness)) return;
  method_ = BendingMethod::diagonal;
  inertia_ = inertia;
  stiffness_ = stiffness;
  for (std::size_t slot = 0; slot < rows_.slots(); ++slot) {
    const double own = inertia * rows_.mass[slot] + stiffness * rows_.diagonal[slot];
    reciprocal_[slot] = rows_.mass[slot] > 0 ? 1 / own : 0;
  }
}

/// A factorisation serves all substeps of about its length, so that a frame which is a little
/// longer than the last one costs none: it is that of a round number.
void BendingSystem::prepare_factor(const BendingFronts& fronts, double inertia, double stiffness) {
  if (is_prepared(BendingMethod::factor, inertia, stiffness)) return;
  prepare_diagonal(inertia, stiffness);
  method_ = BendingMethod::factor;
  const double level = std::round(kFactorsPerOctave * std::log2(inertia)) / kFactorsPerOctave;
  const double round = std::exp2(level);
  auto found = std::ranges::find_if(
      made_, [&](const Factor& f) { return f.inertia == round && f.stiffness == stiffness; });
  if (found == made_.end()) {
    if (made_.size() < kMostFactors) {
      made_.push_back({.factor = std::make_unique<BendingFactor>(rows_, fronts, table_)});
      found = made_.end() - 1;
    } else {
      found = std::ranges::min_element(made_, {}, &Factor::used);
    }
    found->inertia = round;
    found->stiffness = stiffness;
    found->factor->factorise(round, stiffness);
  }
  found->used = ++uses_;
  factor_ = found->factor.get();
}

/// Returns r . P r; z = P r of a factorisation.
double BendingSystem::precondition(Team& team) {
  factor_->solve(residual_.data(), z_.data());
  return sum(team, [&](std::size_t first, std::size_t last) {
    return table_.dot_vectors(residual_.data(), z_.data(), first, last);
  });
}

double BendingSystem::solve(double inertia, double part, double least, int most_iterations,
                            Team& team) {
  const simd::BendingGradients g = gradients();
  const simd::BendingMatrix matrix = rows_.matrix(inertia, stiffness_);
  const bool has_factor = method_ == BendingMethod::factor;
  const auto for_slots = [&](auto&& work) { team.for_each_part(rows_.slots(), kPart, work); };
  const auto step = [&](double alpha) {
    const double now = sum(team, [&](std::size_t first, std::size_t last) {
      return table_.step_gradients(g, alpha, first, last);
    });
    return has_factor ? precondition(team) : now;
  };
  for_slots([&](std::size_t first, std::size_t last) {
    for (double* vector : {g.x, g.direction, g.product})
      std::fill(vector + 4 * first, vector + 4 * last, 0.0);
  });
  double before = 1, now = step(0);
  const double start = now, enough = std::max(least, part * part * start);
  for (iterations_ = 0; iterations_ < most_iterations && now > enough; ++iterations_) {
    const double turn = iterations_ == 0 ? 0 : now / before;
    for_slots([&](std::size_t first, std::size_t last) {
      if (has_factor)
        table_.turn_gradients_to(g, z_.data(), turn, first, last);
      else
        table_.turn_gradients(g, turn, first, last);
    });
    const double curved = sum(team, [&](std::size_t first, std::size_t last) {
      return table_.multiply_bending(matrix, g.direction, g.product, first / simd::kBendingRows,
                                     last / simd::kBendingRows);
    });
    if (!(curved > 0)) break;
    before = now;
    now = step(now / curved);
  }
  return now > least ? std::sqrt(now / start) : 0;
}

std::size_t BendingSystem::bytes() const {
  std::size_t of_factors = 0;
  for (const Factor& made : made_) of_factors += made.factor->bytes();
  return 5 * bytes_of(x_) + bytes_of(sums_) + bytes_of(reciprocal_) + of_factors;
}

}  // namespace weft
