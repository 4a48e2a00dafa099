#include "engine/solvers/small_steps/bending_layout.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/model/bending_element.h"
#include "engine/model/model.h"
#include "engine/solvers/small_steps/bending_arms.h"
#include "engine/solvers/small_steps/element_batches.h"
#include "kernels/reference/bending.h"

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

  void add_batches(bool four) {
    std::vector<std::uint32_t> elements;
    for (std::uint32_t i = 0; i < store_.size(); ++i) {
      if (has_four(i) == four && inverse_mass(i) > 0) elements.push_back(i);
    }
    for (const auto& batch : batches_of(std::move(elements), model_.slots(),
                                        [&](std::uint32_t i) { return slots(i); })) {
      const auto first = static_cast<std::uint32_t>(layout_.blocks.size());
      for_each_block(batch, [&](std::span<const std::uint32_t> of_block) {
        add_block(of_block);
        if (is_folded_) add_folds(of_block);
      });
      layout_.batches.push_back({first, static_cast<std::uint32_t>(layout_.blocks.size()), four});
    }
  }

 private:
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
  void add_block(std::span<const std::uint32_t> elements) {
    simd::BendingBlock& block = layout_.blocks.emplace_back();
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      for (auto& slot : block.slot) slot[lane] = model_.spare_slots + lane;
      block.softness[lane] = 1;
      if (lane < elements.size()) fill(block, lane, elements[lane]);
      layout_.element.push_back(lane < elements.size() ? elements[lane] : kNoIndex);
    }
  }
  void add_folds(std::span<const std::uint32_t> elements) {
    simd::BendingFolds& folds = layout_.folds.emplace_back();
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      const bool is_there = lane < elements.size();
      folds.fold[lane] = is_there ? static_cast<float>(store_.fold[elements[lane]]) : 0;
      folds.yields[lane] = is_there && store_.yields(elements[lane]) ? 1 : 0;
    }
  }
  void fill(simd::BendingBlock& block, std::uint32_t lane, std::uint32_t i) {
    const auto order = reference::order_of_arms(element_of(store_, i));
    for (std::size_t k = 0; k < particles(i); ++k) block.slot[k][lane] = store_.slots[i][order[k]];
    for (std::size_t k = 0; k < particles(i) - 1; ++k)
      block.weight[k][lane] = static_cast<float>(store_.weights[i][order[kInBlock[k]]]);
    if (!has_four(i)) {
      block.slot[3][lane] = layout_.beside[i].value_or(block.slot[1][lane]);
      block.weight[2][lane] = layout_.beside[i] ? 0 : 1;
    }
    block.rest[lane] = static_cast<float>(store_.rest[i]);
    block.stiffness[lane] = to_positive_float(1 / store_.compliance[i]);
    block.softness[lane] = to_positive_float(store_.compliance[i] / inverse_mass(i));
    layout_.curved = layout_.curved || store_.rest[i] > 0;
  }

  const Model& model_;
  const BendingStore& store_;
  BendingLayout& layout_;
  const bool is_folded_ = store_.is_folded() || store_.may_yield();
};

std::vector<std::uint32_t> places_of(const std::vector<std::uint32_t>& elements,
                                     std::size_t count) {
  std::vector<std::uint32_t> places(count, kNoIndex);
  for (std::uint32_t at = 0; at < elements.size(); ++at)
    if (elements[at] != kNoIndex) places[elements[at]] = at;
  return places;
}

}  // namespace

BendingLayout make_bending_layout(const Model& model) {
  BendingLayout layout;
  if (model.bending.size() == 0) return layout;
  layout.beside = particles_beside(model);
  BendingLayoutBuilder builder(model, layout);
  for (const bool four : {false, true}) builder.add_batches(four);
  layout.blocks.shrink_to_fit();
  layout.element.shrink_to_fit();
  layout.folds.shrink_to_fit();
  layout.rows = make_bending_rows(model);
  layout.creases = make_crease_layout(model);
  if (model.bending.may_yield()) layout.place = places_of(layout.element, model.bending.size());
  return layout;
}

std::size_t BendingLayout::bytes() const {
  return bytes_of(blocks) + bytes_of(element) + bytes_of(batches) + bytes_of(beside) +
         bytes_of(folds) + bytes_of(place) + creases.bytes() + rows.bytes();
}

}  // namespace weft
