#include "engine/solvers/small_steps/bending_layout.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/model/model.h"
#include "engine/solvers/small_steps/element_batches.h"
#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::kLanes;

constexpr std::size_t kInBlock[] = {0, 1, 3};  // particles whose weights a block holds

float to_positive_float(double number) {
  return static_cast<float>(std::clamp<double>(number, std::numeric_limits<float>::min(),
                                               std::numeric_limits<float>::max()));
}

class BendingLayoutBuilder {
 public:
  BendingLayoutBuilder(const Model& model, BendingLayout& layout)
      : model_(model), store_(model.bending), layout_(layout) {}

  /// Classes of equal numbers of elements, by their stiffness; where the next of them is not much
  /// softer it is part of the one before.
  void add_classes() {
    std::vector<std::uint32_t> all = movable_elements();
    std::ranges::stable_sort(all, std::greater{}, [&](std::uint32_t i) { return stiffness(i); });
    for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
      while (last < all.size() &&
             stiffness(all[last]) >= tuning::kLikeStiffness * stiffness(all[first]))
        last = std::min(all.size(),
                        last + (all.size() + tuning::kMostClasses - 1) / tuning::kMostClasses);
      const auto begin = static_cast<std::uint32_t>(layout_.batches.size());
      const std::span<const std::uint32_t> elements = std::span(all).subspan(first, last - first);
      for (const bool four : {false, true}) add_batches(elements, four);
      layout_.classes.push_back(
          {begin, static_cast<std::uint32_t>(layout_.batches.size()), stiffness(elements.front())});
    }
  }

 private:
  void add_batches(std::span<const std::uint32_t> of_class, bool four) {
    std::vector<std::uint32_t> elements;
    std::ranges::copy_if(of_class, std::back_inserter(elements),
                         [&](std::uint32_t i) { return has_four(i) == four; });
    for (const auto& batch : batches_of(std::move(elements), model_.slots(),
                                        [&](std::uint32_t i) { return slots(i); })) {
      const auto first = static_cast<std::uint32_t>(layout_.blocks.size());
      for_each_block(batch, [&](std::span<const std::uint32_t> of_block) { add_block(of_block); });
      layout_.batches.push_back({first, static_cast<std::uint32_t>(layout_.blocks.size()), four});
    }
  }
  bool has_four(std::uint32_t i) const { return store_.slots[i][3] != store_.slots[i][2]; }
  std::size_t particles(std::uint32_t i) const { return has_four(i) ? 4 : 3; }
  std::span<const std::uint32_t> slots(std::uint32_t i) const {
    return std::span(store_.slots[i]).first(particles(i));
  }
  /// W, 1/kg
  double inverse_mass(std::uint32_t i) const {
    double sum = 0;
    for (std::size_t k = 0; k < particles(i); ++k) {
      const double c = store_.weights[i][k];
      sum += model_.inverse_mass[store_.slots[i][k]] * c * c;
    }
    return sum;
  }
  /// 1/s^2
  double stiffness(std::uint32_t i) const { return inverse_mass(i) / store_.compliance[i]; }
  std::vector<std::uint32_t> movable_elements() const {
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < store_.size(); ++i) {
      if (inverse_mass(i) > 0) all.push_back(i);
    }
    return all;
  }
  void add_block(std::span<const std::uint32_t> elements) {
    simd::BendingBlock& block = layout_.blocks.emplace_back();
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      for (auto& slot : block.slot) slot[lane] = model_.spare_slots + lane;
      block.softness[lane] = 1;
      if (lane < elements.size()) fill(block, lane, elements[lane]);
      const bool holds = lane < elements.size();
      layout_.element.push_back(holds ? elements[lane] : kNoIndex);
      layout_.stiffness.push_back(holds ? to_positive_float(1 / store_.compliance[elements[lane]])
                                        : 0);
    }
  }
  void fill(simd::BendingBlock& block, std::uint32_t lane, std::uint32_t i) {
    const double inverse = inverse_mass(i);
    for (std::size_t k = 0; k < particles(i); ++k) {
      const std::uint32_t slot = store_.slots[i][k];
      const double w = model_.inverse_mass[slot];
      block.slot[k][lane] = slot;
      block.share[k][lane] = static_cast<float>(w * store_.weights[i][k] / inverse);
    }
    for (std::size_t k = 0; k < 3; ++k)
      block.weight[k][lane] = static_cast<float>(store_.weights[i][kInBlock[k]]);
    block.rest[lane] = static_cast<float>(store_.rest[i]);
    block.softness[lane] = to_positive_float(store_.compliance[i] / inverse);
    layout_.curved = layout_.curved || store_.rest[i] > 0;
  }

  const Model& model_;
  const BendingStore& store_;
  BendingLayout& layout_;
};

}  // namespace

BendingLayout make_bending_layout(const Model& model) {
  BendingLayout layout;
  if (model.bending.size() == 0) return layout;
  BendingLayoutBuilder(model, layout).add_classes();
  return layout;
}

std::size_t BendingLayout::bytes() const {
  return bytes_of(blocks) + bytes_of(element) + bytes_of(stiffness) + bytes_of(batches) +
         bytes_of(classes);
}

}  // namespace weft
