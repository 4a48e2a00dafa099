#include "engine/solvers/small_steps/simd_bending.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/bytes_of.h"
#include "engine/solvers/small_steps/small_steps_layout.h"

namespace weft {
namespace {

constexpr std::size_t kPart = 256;  // slots that a thread takes at a time

float to_finite_float(double number) {
  return static_cast<float>(std::min<double>(number, std::numeric_limits<float>::max()));
}

}  // namespace

SimdBending::SimdBending(const Model& model, const Settings& settings, const simd::Table& table)
    : model_(model),
      layout_(model.small_steps().bending),
      table_(table),
      solver_(model, settings, table),
      spans_(layout_.blocks.size()),
      energies_(layout_.blocks.size()) {
  if (!layout_.empty()) pulls_.resize(4 * model.slots());
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
void SimdBending::for_slots(Team& team, Work&& work) const {
  team.for_each_part(model_.slots(), kPart, work);
}

void SimdBending::begin(const FramePlan& plan, const float* acceleration) {
  if (layout_.empty()) return;
  double weight = 0;
  for (std::size_t slot = 0; slot < model_.slots(); ++slot) {
    if (!solver_.is_free(slot)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<double>(acceleration[4 * slot + k]);
      weight += model_.mass[slot] * a * a;
    }
  }
  solver_.begin(plan, weight);
}

void SimdBending::measure_base(const float* base, Team& team) {
  for_blocks(team, [&](bool four, std::size_t first, std::size_t last) {
    table_.measure_bending(layout_.blocks.data(), spans_.data(), base, four, first, last);
  });
}

void SimdBending::bend(float* u, const float* v, double give, Team& team) {
  const int n = solver_.next();
  if (n == 0) return;
  const simd::Bending bending{.u = u,
                              .v = v,
                              .blocks = layout_.blocks.data(),
                              .spans = spans_.data(),
                              .curved = layout_.curved,
                              .damping = static_cast<float>(solver_.damping())};
  for_slots(team, [&](std::size_t first, std::size_t last) {
    std::fill(pulls_.data() + 4 * first, pulls_.data() + 4 * last, 0.f);
  });
  for_blocks(team, [&](bool four, std::size_t first, std::size_t last) {
    table_.pull_bending(bending, pulls_.data(), four, first, last);
  });
  double* const residual = solver_.residual();
  for_slots(team, [&](std::size_t first, std::size_t last) {
    for (std::size_t slot = first; slot < last; ++slot) {
      const float free = solver_.is_free(slot) ? 1.f : 0.f;
      for (std::size_t k = 4 * slot; k < 4 * slot + 4; ++k)
        residual[k] = static_cast<double>(free * pulls_[k]);
    }
  });
  solver_.solve(n, give, team);
  const double* const by = solver_.solution();
  for_slots(team, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = 4 * first; k < 4 * last; ++k) u[k] += static_cast<float>(by[k]);
  });
}

double SimdBending::energy(const float* u, double give, Team& team) {
  if (layout_.empty()) return 0;
  const simd::Bending bending{.u = u,
                              .blocks = layout_.blocks.data(),
                              .spans = spans_.data(),
                              .resolved = to_finite_float(solver_.resolved(give))};
  for_blocks(team, [&](bool four, std::size_t first, std::size_t last) {
    table_.bending_energy(bending, energies_.data(), four, first, last);
  });
  return std::accumulate(energies_.begin(), energies_.end(), 0.0);
}

std::size_t SimdBending::bytes() const {
  return bytes_of(spans_) + bytes_of(energies_) + bytes_of(pulls_) + solver_.bytes();
}

}  // namespace weft
