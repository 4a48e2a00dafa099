#include "engine/solvers/small_steps/membrane_layout.h"

#include <algorithm>
#include <span>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/model/model.h"
#include "engine/solvers/small_steps/element_batches.h"

namespace weft {
namespace {

using kernels::kLanes;

/// 1/s^2. Stiffer elements do not exist, and floats hold this.
constexpr double kStiffest = 1e30;

class MembraneLayoutBuilder {
 public:
  MembraneLayoutBuilder(const Model& model, MembraneLayout& layout)
      : model_(model), store_(model.membrane), layout_(layout) {
    layout.place.resize(store_.size());
  }

  void add_batches(bool rope) {
    std::vector<std::uint32_t> elements;
    for (std::uint32_t i = 0; i < store_.size(); ++i) {
      if (store_.element[i].is_rope == rope) elements.push_back(i);
    }
    const auto slots_of = [&](std::uint32_t i) { return std::span(store_.slots[i]); };
    for (const auto& batch : batches_of(std::move(elements), model_.slots(), slots_of)) {
      const auto first = static_cast<std::uint32_t>(layout_.blocks.size());
      for_each_block(batch, [&](std::span<const std::uint32_t> of_block) { add_block(of_block); });
      layout_.batches.push_back({first, static_cast<std::uint32_t>(layout_.blocks.size()), rope});
    }
  }

 private:
  void add_block(std::span<const std::uint32_t> elements) {
    simd::MembraneBlock& block = layout_.blocks.emplace_back();
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      for (auto& place : block.place) place[lane] = 4 * (model_.spare_slots + lane);
      const bool holds = lane < elements.size();
      if (holds) {
        fill(block, lane, elements[lane]);
        layout_.place[elements[lane]] = static_cast<std::uint32_t>(layout_.element.size());
      }
      layout_.element.push_back(holds ? elements[lane] : kNoIndex);
    }
  }
  void fill(simd::MembraneBlock& block, std::uint32_t lane, std::uint32_t i) const {
    const auto& [shape, mobility, stiffness, is_rope] = store_.element[i];
    const double most = mobility.most();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t slot = store_.slots[i][k];
      const double share = model_.inverse_mass[slot] / most;
      block.place[k][lane] = 4 * slot;
      block.share_u[k][lane] = static_cast<float>(share * shape.u[k]);
      block.share_v[k][lane] = static_cast<float>(share * shape.v[k]);
      block.stiffness[k][lane] =
          static_cast<float>(std::min(stiffness[k] * shape.area * most, kStiffest));
    }
    for (std::size_t k = 0; k < 2; ++k) {
      block.u[k][lane] = static_cast<float>(shape.u[k + 1]);
      block.v[k][lane] = static_cast<float>(shape.v[k + 1]);
    }
    const double over_most[] = {mobility.uu / most, mobility.uv / most, mobility.vv / most};
    for (std::size_t k = 0; k < 3; ++k) block.mobility[k][lane] = static_cast<float>(over_most[k]);
  }

  const Model& model_;
  const MembraneStore& store_;
  MembraneLayout& layout_;
};

}  // namespace

MembraneLayout make_membrane_layout(const Model& model) {
  MembraneLayout layout;
  if (model.membrane.size() == 0) return layout;
  MembraneLayoutBuilder builder(model, layout);
  for (const bool rope : {false, true}) builder.add_batches(rope);
  return layout;
}

std::size_t MembraneLayout::bytes() const {
  return bytes_of(blocks) + bytes_of(element) + bytes_of(place) + bytes_of(batches);
}

}  // namespace weft
