#include "engine/solvers/small_steps/simd_bending.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/bytes_of.h"
#include "engine/solvers/small_steps/small_steps_layout.h"

namespace weft {
namespace {

float to_finite_float(double number) {
  return static_cast<float>(std::min<double>(number, std::numeric_limits<float>::max()));
}

}  // namespace

SimdBending::SimdBending(const Model& model, const simd::Table& table)
    : layout_(model.small_steps().bending),
      table_(table),
      paces_(paces_of(layout_, model.damping.bending)),
      spans_(layout_.blocks.size()),
      energies_(layout_.blocks.size()) {}

template <class Work>
void SimdBending::for_blocks(std::span<const BendingBatch> batches, Team& team, Work&& work) const {
  for (const BendingBatch& batch : batches) {
    team.for_each_share(batch.last - batch.first, [&](std::size_t first, std::size_t last) {
      work(batch.four, batch.first + first, batch.first + last);
    });
  }
}

simd::Bending SimdBending::arrays(float* u) const {
  return {
      .u = u, .blocks = layout_.blocks.data(), .spans = spans_.data(), .curved = layout_.curved};
}

void SimdBending::measure_base(const float* base, Team& team) {
  for_blocks(layout_.batches, team, [&](bool four, std::size_t first, std::size_t last) {
    table_.measure_bending(layout_.blocks.data(), spans_.data(), base, four, first, last);
  });
}

void SimdBending::bend(float* u, const float* v, double give, Team& team) {
  simd::Bending bending = arrays(u);
  bending.v = v;
  for (std::size_t k = 0; k < paces_.size(); ++k) {
    const int n = paces_[k].next();
    if (n == 0) continue;
    const reference::BendingVisit visit = paces_[k].visit(n, give);
    bending.own = to_finite_float(visit.own);
    bending.rate = to_finite_float(visit.rate);
    bending.damping = to_finite_float(visit.damping);
    bending.most = to_finite_float(visit.most);
    const BendingClass& c = layout_.classes[k];
    const auto batches = std::span(layout_.batches).subspan(c.first, c.last - c.first);
    for_blocks(batches, team, [&](bool four, std::size_t first, std::size_t last) {
      table_.bend(bending, four, first, last);
    });
  }
}

double SimdBending::energy(float* u, double give, Team& team) {
  if (paces_.empty()) return 0;
  simd::Bending bending = arrays(u);
  bending.resolved = to_finite_float(paces_.front().resolved(give));
  for_blocks(layout_.batches, team, [&](bool four, std::size_t first, std::size_t last) {
    table_.bending_energy(bending, layout_.stiffness.data(), energies_.data(), four, first, last);
  });
  return std::accumulate(energies_.begin(), energies_.end(), 0.0);
}

std::size_t SimdBending::bytes() const { return bytes_of(spans_) + bytes_of(energies_); }

}  // namespace weft
