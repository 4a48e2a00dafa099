#include "engine/solvers/small_steps/make_small_steps_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "engine/measure/simd_layout.h"
#include "engine/model/model.h"
#include "engine/solvers/small_steps/constraints_of_yarns.h"
#include "engine/solvers/small_steps/find_load.h"

namespace weft {
namespace {

using kernels::kLanes;

/// Slots as quads, and nothing else.
YarnLayout no_yarns(const Model& model) {
  YarnLayout layout;
  layout.family_begin = {0};
  layout.places.floats = layout.places.padding = 4 * model.slots();
  return layout;
}

/// Edge blocks of the constraints that are not in yarns.
class SmallStepsLayoutBuilder {
 public:
  SmallStepsLayoutBuilder(const Model& model, std::span<const std::uint32_t> in_yarns,
                          SmallStepsLayout& layout)
      : model_(model), layout_(layout), is_in_yarn_(model.constraints.size()) {
    for (const std::uint32_t c : in_yarns) is_in_yarn_[c] = true;
  }

  void add_batches() {
    const Ordering& ordering = model_.ordering;
    const auto add = [&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t i = first; i < last; ++i) add_batch(ordering.batches[i]);
    };
    for (const Tile& tile : ordering.tiles) {
      const auto first = static_cast<std::uint32_t>(layout_.batches.size());
      add(tile.first_batch, tile.last_batch);
      layout_.tiles.push_back({first, static_cast<std::uint32_t>(layout_.batches.size())});
    }
    layout_.between_tiles = static_cast<std::uint32_t>(layout_.batches.size());
    add(ordering.between_tiles, static_cast<std::uint32_t>(ordering.batches.size()));
  }

 private:
  bool is_single(std::uint32_t slot) const {
    const std::uint32_t c = model_.simd().constraint_at[slot];
    return c != kNoIndex && !is_in_yarn_[c];
  }
  /// The other slots of the batch, which share no particle with these, are padding.
  void add_batch(const Batch& batch) {
    const auto first = static_cast<std::uint32_t>(layout_.blocks.size());
    slots_.resize(batch.last - batch.first);
    std::iota(slots_.begin(), slots_.end(), batch.first);
    const auto others = std::stable_partition(slots_.begin(), slots_.end(),
                                              [&](std::uint32_t slot) { return is_single(slot); });
    const auto singles = static_cast<std::size_t>(others - slots_.begin());
    for (std::size_t i = 0; i < singles; i += kLanes)
      add_block(std::span(slots_).subspan(i, kLanes));
    const auto last = static_cast<std::uint32_t>(layout_.blocks.size());
    if (first < last) layout_.batches.push_back({first, last, batch.kind == ConstraintKind::rope});
  }
  void add_block(std::span<const std::uint32_t> slots) {
    const SimdLayout& simd = model_.simd();
    simd::EdgeBlock& block = layout_.blocks.emplace_back();
    std::uint32_t used = 0;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t slot = slots[lane];
      const bool is_one = is_single(slot);
      block.a[lane] = simd.a[slot];
      block.b[lane] = simd.b[slot];
      block.share_a[lane] = static_cast<float>(is_one ? simd.share_a[slot] : 0);
      block.share_b[lane] = static_cast<float>(is_one ? simd.share_b[slot] : 0);
      block.square[lane] =
          static_cast<float>(is_one ? simd.rest_length[slot] * simd.rest_length[slot] : 1);
      layout_.constraint.push_back(is_one ? simd.constraint_at[slot] : kNoIndex);
      used |= (is_one ? 1u : 0u) << lane;
    }
    layout_.used.push_back(static_cast<std::uint16_t>(used));
  }

  const Model& model_;
  SmallStepsLayout& layout_;
  std::vector<bool> is_in_yarn_;
  std::vector<std::uint32_t> slots_;  // constraint slots of a batch
};

void add_springs(const Model& model, SmallStepsLayout& layout) {
  const ConstraintStore& store = model.constraints;
  layout.multiplier_place.resize(store.size());
  const auto place = [&](std::uint32_t c, std::size_t at) {
    if (c != kNoIndex) layout.multiplier_place[c] = static_cast<std::uint32_t>(at);
  };
  for (std::size_t i = 0; i < layout.blocks.size(); ++i) {
    simd::SpringBlock& block = layout.springs.emplace_back();
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t at = i * kLanes + lane;
      const std::uint32_t c = layout.constraint[at];
      const bool is_one = c != kNoIndex;
      block.rest[lane] = static_cast<float>(is_one ? store.rest_length[c] : 1);
      block.inverse_masses[lane] = static_cast<float>(is_one ? 1 / store.effective_mass[c] : 1);
      block.compliance[lane] = is_one ? store.compliance_in_lanes(c) : 0;
      place(c, at);
    }
  }
  for (std::size_t i = 0; i < layout.serial.size(); ++i) {
    place(layout.serial[i], layout.constraint.size() + i);
  }
  for (std::size_t i = 0; i < layout.yarns.constraint.size(); ++i) {
    place(layout.yarns.constraint[i], layout.first_multiplier_of_yarns() + i);
  }
}

/// As yarns' cell (kernels/simd/yarn_rows.h), of all constraints and triangles of fabric.
double cell_of(const Model& model) {
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  const auto take = [&](double length) {
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  };
  for (const double rest : model.constraints.rest_length) take(rest);
  model.membrane.for_each_side([&](std::uint32_t, std::uint32_t, double side) { take(side); });
  if (longest == 0) return 0;
  return std::exp2(std::floor(std::log2(std::min(8 * shortest, longest / 64))));
}

void set_compliances(const Model& model, YarnLayout& yarns) {
  for (simd::YarnBlock& block : yarns.blocks) {
    for (std::size_t lane = 0; lane < block.lanes; ++lane) {
      const auto slots = slots_of(model.constraints, links_of(yarns, block, lane));
      block.compliance[lane] = static_cast<float>(compliance_of_yarn(model, slots));
    }
  }
}

}  // namespace

SmallStepsLayout make_small_steps_layout(const Model& model) {
  const ConstraintStore& store = model.constraints;
  SmallStepsLayout layout;
  layout.bending = make_bending_layout(model);
  layout.membrane = make_membrane_layout(model);
  const bool weaves = store.plain == store.size() && !store.has_springs() &&
                      layout.membrane.empty() && layout.bending.empty();
  const YarnMemory memory = weaves ? YarnMemory::woven_if_possible : YarnMemory::quads;
  layout.linkage = make_linkage_layout(model);
  const bool is_linkage = !layout.linkage.empty();
  const std::vector<std::uint32_t> in_yarns =
      is_linkage ? std::vector<std::uint32_t>() : constraints_of_yarns(model);
  layout.yarns =
      in_yarns.empty() ? no_yarns(model) : make_yarn_layout(model, in_yarns, memory, true);
  set_compliances(model, layout.yarns);
  if (!is_linkage) {
    SmallStepsLayoutBuilder(model, in_yarns, layout).add_batches();
    for (const auto* hubs : {&store.hub_distances, &store.hub_ropes})
      layout.serial.insert(layout.serial.end(), hubs->begin(), hubs->end());
  }
  if (store.has_springs()) add_springs(model, layout);
  layout.cell = layout.has_yarns() ? layout.yarns.cell : cell_of(model);
  layout.floats = kernels::round_up(layout.yarns.places.floats, std::size_t{kLanes});
  layout.anchors = make_anchor_layout(model, layout.places());
  layout.items = make_local_items(model);
  layout.load = find_load(model, layout);
  return layout;
}

SmallStepsLayout with_bending_of(const Model& model, SmallStepsLayout layout) {
  layout.bending = make_bending_layout(model);
  return layout;
}

const SmallStepsLayout& Model::small_steps() const {
  return small_steps_.get([this] { return make_small_steps_layout(*this); });
}

void Model::renew_bending_layout() {
  if (const SmallStepsLayout* layout = small_steps_.if_made())
    small_steps_.put(std::make_shared<const SmallStepsLayout>(with_bending_of(*this, *layout)));
}

}  // namespace weft
