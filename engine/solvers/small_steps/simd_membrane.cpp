#include "engine/solvers/small_steps/simd_membrane.h"

#include <algorithm>

#include "engine/bytes_of.h"
#include "engine/solvers/small_steps/membrane_laws.h"
#include "engine/solvers/small_steps/small_steps_layout.h"

namespace weft {

using kernels::kLanes;

SimdMembrane::SimdMembrane(const Model& model, const simd::Table& table)
    : model_(model),
      layout_(model.small_steps().membrane),
      table_(table),
      spans_(layout_.blocks.size()),
      multiplier_(reference::kMembraneLaws * layout_.element.size()),
      out_(layout_.blocks.size()) {}

void SimdMembrane::measure_base(const float* base, Team& team) {
  team.for_each_share(layout_.blocks.size(), [&](std::size_t first, std::size_t last) {
    table_.measure_membrane(layout_.blocks.data(), spans_.data(), base, first, last);
  });
}

simd::Membrane SimdMembrane::arrays(float* u, const float* u_start, const LawStep& laws) {
  const reference::MembraneStep step = membrane_step(laws);
  return {.u = u,
          .u_start = u_start,
          .blocks = layout_.blocks.data(),
          .spans = spans_.data(),
          .multiplier = multiplier_.data(),
          .give = static_cast<float>(step.give),
          .damping = static_cast<float>(step.damping)};
}

template <class Work>
void SimdMembrane::for_blocks(Team& team, Work&& work) const {
  for (const MembraneBatch& batch : layout_.batches) {
    team.for_each_share(batch.last - batch.first, [&](std::size_t first, std::size_t last) {
      work(batch.rope, batch.first + first, batch.first + last);
    });
  }
}

void SimdMembrane::relax(float* u, const float* u_start, const LawStep& laws, double omega,
                         bool continues, Team& team) {
  if (laws.leaves_triangles()) return;
  const simd::Membrane membrane = arrays(u, u_start, laws);
  for_blocks(team, [&](bool rope, std::size_t first, std::size_t last) {
    table_.relax_membrane(membrane, static_cast<float>(omega), continues, rope, first, last);
  });
}

void SimdMembrane::judge(float* u, const float* u_start, const LawStep& laws, double strain,
                         Team& team) {
  if (laws.leaves_triangles()) {
    std::ranges::fill(out_, 0);
    return;
  }
  const simd::Membrane membrane = arrays(u, u_start, laws);
  for_blocks(team, [&](bool rope, std::size_t first, std::size_t last) {
    table_.judge_membrane(membrane, static_cast<float>(strain), out_.data(), rope, first, last);
  });
}

std::int64_t SimdMembrane::count_out() const {
  std::int64_t count = 0;
  for (const std::uint32_t bits : out_) count += std::popcount(bits);
  return count;
}

reference::MembraneMultipliers SimdMembrane::multipliers(std::uint32_t element) const {
  const float* const from = multiplier_.data() + multiplier_place(element);
  const double over = 1 / mobility(element);
  reference::MembraneMultipliers multipliers;
  for (std::size_t k = 0; k < multipliers.size(); ++k)
    multipliers[k] = over * static_cast<double>(from[k * kLanes]);
  return multipliers;
}

void SimdMembrane::set_multipliers(std::uint32_t element,
                                   const reference::MembraneMultipliers& to) {
  float* const at = multiplier_.data() + multiplier_place(element);
  const double by = mobility(element);
  for (std::size_t k = 0; k < to.size(); ++k) at[k * kLanes] = static_cast<float>(by * to[k]);
}

std::size_t SimdMembrane::bytes() const {
  return bytes_of(spans_) + bytes_of(multiplier_) + bytes_of(out_);
}

}  // namespace weft
