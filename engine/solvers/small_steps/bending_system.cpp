#include "engine/solvers/small_steps/bending_system.h"

#include <algorithm>
#include <cmath>

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
  for (auto* vector : {&guess_, &change_, &residual_, &direction_, &product_})
    vector->resize(4 * rows_.slots());
  reciprocal_.resize(rows_.slots());
  sums_.resize((rows_.slots() + kSlotsOfSum - 1) / kSlotsOfSum);
  norms_.resize(sums_.size());
}

template <class Real>
simd::BendingGradients<Real> BendingSystem<Real>::gradients() {
  return {residual_.data(), direction_.data(), product_.data(),
          change_.data(),   guess_.data(),     reciprocal_.data()};
}

template <class Real>
template <class Work>
void BendingSystem<Real>::for_slots(Team& team, Work&& work) const {
  team.for_each_part(rows_.slots(), kSlotsOfSum, work);
}

/// Of what work(first, last) returns for the slots of each range, in one order.
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
  if (law == prepared_ && factor_ == nullptr) return;
  if (guess_.empty()) allocate();
  prepared_ = law;
  factor_ = nullptr;
  const BendingValues<double>& of = rows_.doubles;
  for (std::size_t slot = 0; slot < rows_.slots(); ++slot) {
    const double own = law.inertia * of.mass[slot] + law.stiffness * of.diagonal[slot];
    reciprocal_[slot] = static_cast<Real>(of.mass[slot] > 0 ? 1 / own : 0);
  }
}

/// A factorisation serves all substeps of about its length, so that a frame which is a little
/// longer than the last one costs none: it is that of a round number.
template <class Real>
void BendingSystem<Real>::prepare_factor(
    const BendingFronts& fronts, const BendingLaw& law) requires std::is_same_v<Real, double> {
  if (law == prepared_ && factor_ != nullptr) return;
  prepare_diagonal(law);
  z_.resize(4 * rows_.slots());
  const double level = std::round(kFactorsPerOctave * std::log2(law.inertia)) / kFactorsPerOctave;
  const BendingLaw round{std::exp2(level), law.stiffness};
  auto found = std::ranges::find_if(made_, [&](const Factor& f) { return f.law == round; });
  if (found == made_.end()) {
    if (made_.size() < kMostFactors) {
      made_.push_back({.factor = std::make_unique<BendingFactor>(rows_, fronts, table_)});
      found = made_.end() - 1;
    } else {
      found = std::ranges::min_element(made_, {}, &Factor::used);
    }
    found->law = round;
    found->factor->factorise(round);
  }
  found->used = ++uses_;
  factor_ = found->factor.get();
}

/// Returns r . P r; z = P r of a factorisation.
template <class Real>
double BendingSystem<Real>::precondition(Team& team) {
  if constexpr (std::is_same_v<Real, double>) {
    factor_->solve(residual_.data(), z_.data());
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
        return table_.turn_gradients_to(direction_.data(), z_.data(), beta, first, last);
    }
    kernels_of<Real>(table_).turn(gradients(), static_cast<Real>(beta), first, last);
  });
}

template <class Real>
double BendingSystem<Real>::solve(const BendingLaw& law, const BendingLimits& limits, Team& team) {
  const simd::BendingGradients<Real> g = gradients();
  const simd::BendingMatrix<Real> a = rows_.matrix<Real>(law);
  const simd::BendingKernels<Real>& kernels = kernels_of<Real>(table_);
  const bool has_factor = factor_ != nullptr;
  const simd::BendingNorms start = sum(team, norms_, [&](std::size_t first, std::size_t last) {
    return kernels.begin(g, a.mass, a.inertia, first, last);
  });
  double before = 1, now = has_factor ? precondition(team) : start.left;
  const double force = std::max(now + start.force, limits.weight);
  const double enough = limits.part * limits.part * force;
  for (steps_ = 0; steps_ < limits.most_steps && now > enough; ++steps_) {
    if (has_factor || steps_ > 0) turn(steps_ > 0 ? now / before : 0, team);
    const double curved = sum(team, [&](std::size_t first, std::size_t last) {
      return kernels.multiply(a, g.direction, g.product, first / simd::kBendingRows,
                              last / simd::kBendingRows);
    });
    if (!(curved > 0)) break;
    before = now;
    const auto by = static_cast<Real>(now / curved);
    now = sum(team, [&](std::size_t first, std::size_t last) {
      return kernels.step(g, by, steps_ == 0, first, last);
    });
    if (has_factor) now = precondition(team);
  }
  return force > 0 ? std::sqrt(now / force) : 0;
}

template <class Real>
std::size_t BendingSystem<Real>::bytes() const {
  std::size_t of_factors = 0;
  for (const Factor& made : made_) of_factors += made.factor->bytes();
  return 5 * bytes_of(guess_) + bytes_of(reciprocal_) + bytes_of(sums_) + bytes_of(norms_) +
         bytes_of(z_) + of_factors;
}

template class BendingSystem<float>;
template class BendingSystem<double>;

}  // namespace weft
