#include "engine/solvers/small_steps/bending_system.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/bytes_of.h"

namespace weft {
namespace {

constexpr std::size_t kSlotsOfSum = 256;  // that a sum goes over at a time
constexpr std::size_t kMostFactors = 3;   // that are kept
constexpr double kFactorsPerOctave = 4;   // of the inertia

template <class Real>
const simd::BendingKernels<Real>& kernels_of(const simd::Table& table) {
  if constexpr (std::is_same_v<Real, float>)
    return table.bend_floats;
  else
    return table.bend_doubles;
}

simd::BendingNorms operator+(const simd::BendingNorms& a, const simd::BendingNorms& b) {
  return {a.left + b.left, a.force + b.force};
}

}  // namespace

template <class Real>
BendingSystem<Real>::BendingSystem(const BendingRows& rows, const simd::Table& table)
    : rows_(rows), table_(table) {
  made_.reserve(kMostFactors);
}

template <class Real>
void BendingSystem<Real>::allocate() {
  for (auto* vector : {&guess_, &change_, &residual_, &product_}) vector->resize(4 * rows_.slots());
  direction_.resize(4 * rows_.slots() + 2 * kAround);
  reciprocal_.resize(rows_.slots());
  sums_.resize((rows_.slots() + kSlotsOfSum - 1) / kSlotsOfSum);
  norms_.resize(sums_.size());
  if constexpr (std::is_same_v<Real, double>) values_ = rows_.values_by_groups<double>();
}

template <class Real>
const Real* BendingSystem<Real>::values() const {
  if constexpr (std::is_same_v<Real, double>)
    return values_.data();
  else
    return rows_.floats.data();
}

template <class Real>
simd::BendingGradients<Real> BendingSystem<Real>::gradients() {
  return {residual_.data(), direction(),   product_.data(),
          change_.data(),   guess_.data(), reciprocal_.data()};
}

template <class Real>
template <class Work>
void BendingSystem<Real>::for_slots(Team& team, Work&& work) const {
  team.for_each_part(rows_.slots(), kSlotsOfSum, work);
}

/// The sum of work(first, last) over the slots of each range, in one order.
template <class Real>
template <class Result, class Work>
Result BendingSystem<Real>::sum(Team& team, std::vector<Result>& parts, Work&& work) const {
  for_slots(team, [&](std::size_t first, std::size_t last) {
    parts[first / kSlotsOfSum] = work(first, last);
  });
  Result all{};
  for (const Result& part : parts) all = all + part;
  return all;
}

template <class Real>
void BendingSystem<Real>::prepare_diagonal(const BendingLaw& law) {
  if (law == prepared_ && factor_ == nullptr && !guess_.empty()) return;
  if (guess_.empty()) allocate();
  prepared_ = law;
  factor_ = nullptr;
  for (std::size_t slot = 0; slot < rows_.slots(); ++slot) {
    const double own = law.inertia * rows_.mass[slot] + law.stiffness * rows_.diagonal[slot];
    reciprocal_[slot] = static_cast<Real>(rows_.bends(slot) ? 1 / own : 0);
  }
}

/// Factorisations of a round number serve all substeps of about its length: frames of changing
/// lengths cost none.
template <class Real>
void BendingSystem<Real>::prepare_factor(const BendingFronts& fronts, const BendingLaw& law,
                                         bool exactly) requires std::is_same_v<Real, double> {
  const double level = std::round(kFactorsPerOctave * std::log2(law.inertia)) / kFactorsPerOctave;
  const BendingLaw of = exactly ? law : BendingLaw{std::exp2(level), law.stiffness};
  if (law == prepared_ && factor_ != nullptr && factor_->law == of) return;
  prepare_diagonal(law);
  z_.resize(4 * rows_.slots());
  auto found = std::ranges::find_if(made_, [&](const Factor& f) { return f.law == of; });
  if (found == made_.end()) {
    if (made_.size() < kMostFactors) {
      made_.push_back({.factor = std::make_unique<BendingFactor>(rows_, fronts, table_)});
      found = made_.end() - 1;
    } else {
      found = std::ranges::min_element(made_, {}, &Factor::used);
    }
    found->law = of;
    found->factor->factorise(of);
  }
  found->used = ++uses_;
  factor_ = &*found;
}

/// Returns r . P r; z = P r of a factorisation.
template <class Real>
double BendingSystem<Real>::precondition(Team& team) {
  if constexpr (std::is_same_v<Real, double>) {
    factor_->factor->solve(residual_.data(), z_.data());
    return sum(team, [&](std::size_t first, std::size_t last) {
      return table_.dot_vectors(residual_.data(), z_.data(), first, last);
    });
  }
  return 0;
}

template <class Real>
void BendingSystem<Real>::turn(double beta, Team& team) {
  for_slots(team, [&](std::size_t first, std::size_t last) {
    if constexpr (std::is_same_v<Real, double>) {
      if (factor_ != nullptr)
        return table_.turn_gradients_to(direction(), z_.data(), beta, first, last);
    }
    kernels_of<Real>(table_).turn(gradients(), static_cast<Real>(beta), first, last);
  });
}

/// r is what is left of the guess, and p = r / diagonal.
template <class Real>
simd::BendingNorms BendingSystem<Real>::begin(const simd::BendingMatrix<Real>& a, Team& team) {
  return sum(team, norms_, [&](std::size_t first, std::size_t last) {
    return kernels_of<Real>(table_).begin(gradients(), a.mass, a.inertia, first, last);
  });
}

/// Returns p . A p.
template <class Real>
double BendingSystem<Real>::multiply(const simd::BendingMatrix<Real>& a, Team& team) {
  return sum(team, [&](std::size_t first, std::size_t last) {
    return kernels_of<Real>(table_).multiply(a, direction(), product_.data(),
                                             first / simd::kBendingRows, last / simd::kBendingRows);
  });
}

/// By so many times p. Returns what is left in the norm of the diagonal, squared.
template <class Real>
double BendingSystem<Real>::step(double by, Team& team) {
  const bool is_first = steps_++ == 0;
  return sum(team, [&](std::size_t first, std::size_t last) {
    return kernels_of<Real>(table_).step(gradients(), static_cast<Real>(by), is_first, first, last);
  });
}

/// Each step takes up what rounding left of the last one.
template <class Real>
double BendingSystem<Real>::solve_exactly(const simd::BendingMatrix<Real>& a,
                                          const BendingLimits& limits, Team& team) {
  const simd::BendingNorms start = begin(a, team);
  const double force = std::max(start.left + start.force, limits.weight);
  const double enough = limits.part * limits.part * force;
  double before = std::numeric_limits<double>::infinity(), now = start.left;
  while (steps_ < limits.most_steps && now > enough && now < before) {
    if constexpr (std::is_same_v<Real, double>)
      factor_->factor->solve(residual_.data(), direction());
    multiply(a, team);
    before = now;
    now = step(1, team);
  }
  return force > 0 ? std::sqrt(now / force) : 0;
}

template <class Real>
double BendingSystem<Real>::solve(const BendingLaw& law, const BendingLimits& limits, Team& team) {
  const simd::BendingMatrix<Real> a = rows_.matrix<Real>(law, values());
  const bool has_factor = factor_ != nullptr;
  steps_ = 0;
  if (has_factor && factor_->law == law) return solve_exactly(a, limits, team);
  const simd::BendingNorms start = begin(a, team);
  double before = 1, now = has_factor ? precondition(team) : start.left;
  const double force = std::max(now + start.force, limits.weight);
  const double enough = limits.part * limits.part * force;
  while (steps_ < limits.most_steps && now > enough) {
    if (has_factor || steps_ > 0) turn(steps_ > 0 ? now / before : 0, team);
    const double curved = multiply(a, team);
    if (!(curved > 0)) break;
    before = now;
    now = step(now / curved, team);
    if (has_factor) now = precondition(team);
  }
  return force > 0 ? std::sqrt(now / force) : 0;
}

template <class Real>
std::size_t BendingSystem<Real>::bytes() const {
  std::size_t of_factors = 0;
  for (const Factor& made : made_) of_factors += made.factor->bytes();
  return 4 * bytes_of(guess_) + bytes_of(direction_) + bytes_of(reciprocal_) + bytes_of(sums_) +
         bytes_of(norms_) + bytes_of(z_) + bytes_of(values_) + of_factors;
}

template class BendingSystem<float>;
template class BendingSystem<double>;

}  // namespace weft
