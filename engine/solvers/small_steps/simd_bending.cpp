#include "engine/solvers/small_steps/simd_bending.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/bytes_of.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/tuning.h"

namespace weft {
namespace {

constexpr std::size_t kFloatsOfPart = 4 * 256;  // that a thread takes at a time

float to_finite_float(double number) {
  return static_cast<float>(std::min<double>(number, std::numeric_limits<float>::max()));
}

}  // namespace

SimdBending::SimdBending(const Model& model, const Settings& settings, const simd::Table& table)
    : model_(model),
      layout_(model.small_steps().bending),
      table_(table),
      frame_(model, settings),
      soft_(layout_.rows, table),
      stiff_(layout_.rows, table),
      spans_(layout_.blocks.size()),
      energies_(layout_.blocks.size()) {
  if (layout_.empty()) return;
  soft_.allocate();
  works_.resize((4 * layout_.rows.slots() + kFloatsOfPart - 1) / kFloatsOfPart);
  const bool is_damped = model.damping.bending > 0, is_folded = !layout_.folds.empty();
  if (is_damped) from_.resize(4 * layout_.rows.slots());
  if (is_damped || is_folded) along_.resize(layout_.blocks.size());
  if (is_damped) across_.resize(layout_.blocks.size());
  if (is_folded) sides_.resize(layout_.blocks.size());
  if (model.bending.may_yield()) folds_ = layout_.folds;
}

void SimdBending::set_fold(std::uint32_t element, double fold) {
  const std::uint32_t at = layout_.place[element];
  if (at == kNoIndex) return;
  folds_[at / kernels::kLanes].fold[at % kernels::kLanes] = static_cast<float>(fold);
}

template <class Work>
void SimdBending::for_blocks(Team& team, Work&& work) const {
  for (const BendingBatch& batch : layout_.batches) {
    team.for_each_share(batch.last - batch.first, [&](std::size_t first, std::size_t last) {
      work(batch.four, batch.first + first, batch.first + last);
    });
  }
}

template <class Work>
void SimdBending::for_floats(Team& team, Work&& work) const {
  team.for_each_part(4 * layout_.rows.slots(), kFloatsOfPart, work);
}

void SimdBending::begin(const FramePlan& plan, const float* acceleration, bool goes_on) {
  if (layout_.empty()) return;
  double weight = 0;
  for (std::size_t slot = 0; slot < layout_.rows.slots(); ++slot) {
    if (!layout_.rows.bends(slot)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<double>(acceleration[4 * slot + k]);
      weight += model_.mass[slot] * a * a;
    }
  }
  frame_.begin(plan, weight);
  give_ = error_ = 0;
  if (frame_.is_factored())
    stiff_.prepare_factor(model_.bending_fronts(), frame_.usual().law(), goes_on);
  else
    soft_.prepare_diagonal(frame_.usual().law());
}

void SimdBending::measure_base(const float* base, Team& team) {
  for_blocks(team, [&](bool four, std::size_t first, std::size_t last) {
    table_.measure_bending(layout_.blocks.data(), spans(), base, four, first, last);
  });
}

void SimdBending::bend(float* u, const float* start, double give, Team& team) {
  const std::optional<BendingStep> step = frame_.next(give);
  if (!step) return;
  if (frame_.is_factored())
    bend_stiffly(u, start, *step, team);
  else
    bend_softly(u, start, *step, team);
}

simd::Bending SimdBending::arrays(const float* u) {
  return {.u = u,
          .blocks = layout_.blocks.data(),
          .spans = spans(),
          .folds = !folds_.empty()          ? folds_.data()
                   : !layout_.folds.empty() ? layout_.folds.data()
                                            : nullptr,
          .curved = layout_.curved,
          .yields = !folds_.empty()};
}

/// Into the residual of soft_.
void SimdBending::pull(const float* u, const float* start, const BendingStep& step, Team& team) {
  float* const pulls = soft_.residual();
  for_floats(team, [&](std::size_t first, std::size_t last) {
    std::fill(pulls + first, pulls + last, 0.f);
  });
  simd::Bending bending = arrays(u);
  bending.start = start;
  bending.damping = static_cast<float>(step.damping);
  bending.resolved = to_finite_float(frame_.resolved_turning(step.give));
  for_blocks(team, [&](bool four, std::size_t first, std::size_t last) {
    table_.pull_bending(bending, pulls, four, first, last);
  });
}

/// A force that depends on where particles are, and not linearly, is that of the prediction. Taken
/// where the last one leads it would be remembered for another substep: what this leaves of a swing
/// and what BDF2 leaves make a third order, which is not stable (perf/tried.md).
bool SimdBending::begins_anew() const { return give_ == 0 || !layout_.folds.empty(); }

/// Particles go where the last force of bending takes them: what is new since then is little.
void SimdBending::begin_from_guess(float* u, const float* start, const BendingStep& step,
                                   Team& team) {
  const bool is_first = begins_anew(), is_damped = step.damping > 0;
  const float scale = is_first ? 0 : static_cast<float>(step.give / give_);
  const auto beyond = static_cast<float>(step.count - 1);
  float* const guess = soft_.guess();
  for_floats(team, [&](std::size_t first, std::size_t last) {
    if (is_first) {
      std::fill(guess + first, guess + last, 0.f);
      if (is_damped) std::copy(start + first, start + last, from_.data() + first);
      return;
    }
    for (std::size_t i = first; i < last; ++i) {
      const float by = scale * guess[i];
      guess[i] = by;
      u[i] += by;
      if (is_damped) from_[i] = start[i] - beyond * by;
    }
  });
  give_ = step.give;
}

void SimdBending::bend_softly(float* u, const float* start, const BendingStep& step, Team& team) {
  begin_from_guess(u, start, step, team);
  pull(u, step.damping > 0 ? from_.data() : start, step, team);
  error_ = std::max(error_, soft_.solve(step.law(), frame_.limits(), team));
  float* const guess = soft_.guess();
  const float* const change = soft_.change();
  const auto count = static_cast<float>(step.count);
  const bool has_changed = soft_.steps() > 0;
  if (!has_changed && count == 1) return;
  for_floats(team, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const float from = guess[i], to = has_changed ? from + change[i] : from;
      guess[i] = to;
      u[i] += count * to - from;
    }
  });
}

/// Elements of damped bending turn as they do where the last force of bending takes them: what
/// stiff cloth is predicted to do by itself is mostly noise.
void SimdBending::bend_stiffly(float* u, const float* start, const BendingStep& step, Team& team) {
  double* const guess = stiff_.guess();
  const bool is_first = begins_anew();
  if (is_first) stiff_.forget_guess();
  const double scale = is_first ? 1 : step.give / give_;
  give_ = step.give;
  for_floats(team, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      guess[i] *= scale;
      u[i] += static_cast<float>(guess[i]);
    }
  });
  error_ = std::max(error_, solve_stiffly(u, start, step, team));
  if (stiff_.steps() == 0) return;
  const double* const by = stiff_.change();
  for_floats(team, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      guess[i] += by[i];
      u[i] += static_cast<float>(by[i]);
    }
  });
}

double SimdBending::solve_stiffly(const float* u, const float* start, const BendingStep& step,
                                  Team& team) {
  const float* const pulls = soft_.residual();
  double* const residual = stiff_.residual();
  pull(u, start, step, team);
  for_floats(team, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) residual[i] = static_cast<double>(pulls[i]);
  });
  return stiff_.solve(step.law(), frame_.limits(), team);
}

double SimdBending::energy(const float* u, double give, Team& team) {
  if (layout_.empty()) return 0;
  simd::Bending bending = arrays(u);
  bending.resolved = to_finite_float(frame_.resolved(give));
  for_blocks(team, [&](bool four, std::size_t first, std::size_t last) {
    table_.bending_energy(bending, energies_.data(), four, first, last);
  });
  return std::accumulate(energies_.begin(), energies_.end(), 0.0);
}

/// The minimum over displacements d of the energy at u + d and d M d / (2 f), by a solution for d.
double SimdBending::releasable_energy(float* u, double give, Team& team) {
  if (layout_.empty()) return 0;
  const double whole = energy(u, 0, team);
  const BendingStep step{1 / frame_.resolved(give), 1, 0};
  pull(u, u, step, team);
  float* const force = u;  // u has been read
  std::copy_n(soft_.residual(), 4 * layout_.rows.slots(), force);
  return whole - (frame_.is_factored() ? released(stiff_, force, step.law(), team)
                                       : released(soft_, force, step.law(), team));
}

/// J, that a force gives on the way to where bending and inertia hold it.
template <class Real>
double SimdBending::released(BendingSystem<Real>& system, const float* force, const BendingLaw& law,
                             Team& team) {
  system.forget_guess();
  std::copy_n(force, 4 * layout_.rows.slots(), system.residual());
  system.solve(law, frame_.limits_of_energy(), team);
  if (system.steps() == 0) return 0;
  for_floats(team, [&](std::size_t first, std::size_t last) {
    double sum = 0;
    for (std::size_t i = first; i < last; ++i)
      sum += static_cast<double>(force[i]) * static_cast<double>(system.change()[i]);
    works_[first / kFloatsOfPart] = 0.5 * sum;
  });
  return std::accumulate(works_.begin(), works_.end(), 0.0);
}

std::size_t SimdBending::bytes() const {
  return bytes_of(spans_) + bytes_of(along_) + bytes_of(across_) + bytes_of(sides_) +
         bytes_of(energies_) + bytes_of(works_) + bytes_of(from_) + soft_.bytes() + stiff_.bytes();
}

}  // namespace weft
