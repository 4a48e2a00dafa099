#include "engine/solvers/small_steps/small_steps_load.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "engine/lists.h"
#include "engine/model/model.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/tuning.h"

namespace weft {

namespace {

/// The particles of each block, and the blocks of each particle. Behind those of constraints each
/// anchored particle that holds is a block that is at a pin.
struct Blocks {
  Lists slots_of, at;
  std::size_t of_constraints = 0;
};

/// Anchored particles that cloth may hang on: a limit that is wider than another by more than a
/// constraint is long is slack where that holds. A pin is a limit of 0.
std::vector<std::uint32_t> anchors_that_hold(const Model& model, double mean_length) {
  const AnchorStore& anchors = model.anchors;
  double least = model.holds.empty() ? std::numeric_limits<double>::infinity() : 0;
  for (const reference::AnchorLimits& limits : anchors.limits) least = std::min(least, limits.most);
  std::vector<std::uint32_t> slots;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    if (anchors.limits[i].most <= least + mean_length && std::isfinite(anchors.limits[i].most))
      slots.push_back(anchors.slot[i]);
  }
  return slots;
}

/// Of the yarn, between each particle that holds and the next.
void add_spans(const Model& model, const std::vector<bool>& holds,
               std::span<const std::uint32_t> links, SmallStepsLoad& load) {
  const std::vector<std::uint32_t> slots = slots_of(model.constraints, links);
  SmallStepsLoad::Span span{kNoIndex, kNoIndex, 0};
  for (std::size_t k = 0; k < slots.size(); ++k) {
    if (k > 0) span.length += model.constraints.rest_length[links[k - 1]];
    if (!holds[slots[k]]) continue;
    span.last_slot = slots[k];
    if (span.first_slot != kNoIndex) load.spans.push_back(span);
    span = {slots[k], kNoIndex, 0};
  }
}

Blocks find_blocks(const Model& model, const SmallStepsLayout& layout,
                   std::span<const std::uint32_t> anchored) {
  Blocks blocks;
  const ConstraintStore& s = model.constraints;
  const auto add = [&](std::uint32_t c) {
    if (c != kNoIndex) blocks.slots_of.push_back(std::vector{s.a[c], s.b[c]});
  };
  for_each_yarn(layout.yarns, [&](std::span<const std::uint32_t> links) {
    blocks.slots_of.push_back(slots_of(s, links));
  });
  std::ranges::for_each(layout.constraint, add);
  std::ranges::for_each(layout.serial, add);
  for (const auto& corners : model.membrane.slots) blocks.slots_of.push_back(std::span(corners));
  for (std::size_t i = 0; i < model.seams.size(); ++i)
    blocks.slots_of.push_back(std::vector{model.seams.a[i], model.seams.b[i]});
  blocks.of_constraints = blocks.slots_of.size();
  for (const std::uint32_t slot : anchored) {
    if (model.inverse_mass[slot] > 0) blocks.slots_of.push_back(std::span(&slot, 1));
  }
  blocks.at = make_lists(model.slots(), [&](auto&& add_at) {
    for (std::uint32_t i = 0; i < blocks.slots_of.size(); ++i) {
      for (const std::uint32_t slot : blocks.slots_of[i]) add_at(slot, i);
    }
  });
  return blocks;
}

/// From the blocks at pins over those that share free particles with them, level by level.
class Levels {
 public:
  Levels(const Model& model, const Blocks& blocks)
      : model_(model), blocks_(blocks), reached_(blocks.slots_of.size()), held_(model.slots()) {}

  /// Particles on a block at a pin; 0: nothing is at a pin.
  double carried() {
    std::vector<std::uint32_t> level, next;
    for (std::uint32_t i = 0; i < reached_.size(); ++i) {
      if (is_pinned(i)) reach(i, level);
    }
    double first_mass = 0, mass = 0, depth = 0;
    for (; !level.empty(); level.swap(next)) {
      next.clear();
      double held = 0;
      for (const std::uint32_t i : level) held += hold(i, next);
      if (held > 0) ++depth;
      mass += held;
      if (first_mass == 0) first_mass = mass;
    }
    constexpr double kOwn = (1 - tuning::kOmega) / 2;
    return depth == 0 ? 0 : std::max(mass / first_mass, depth) - 1 + kOwn;
  }

 private:
  bool is_free(std::uint32_t slot) const { return model_.inverse_mass[slot] > 0; }
  bool is_pinned(std::uint32_t block) const {
    if (block >= blocks_.of_constraints) return true;
    return !std::ranges::all_of(blocks_.slots_of[block],
                                [&](std::uint32_t slot) { return is_free(slot); });
  }
  void reach(std::uint32_t block, std::vector<std::uint32_t>& level) {
    if (reached_[block]) return;
    reached_[block] = true;
    level.push_back(block);
  }
  /// kg, of its particles that no other holds.
  double hold(std::uint32_t block, std::vector<std::uint32_t>& next) {
    double mass = 0;
    for (const std::uint32_t slot : blocks_.slots_of[block]) {
      if (!is_free(slot) || held_[slot]) continue;
      held_[slot] = true;
      mass += 1 / model_.inverse_mass[slot];
      for (const std::uint32_t other : blocks_.at[slot]) reach(other, next);
    }
    return mass;
  }

  const Model& model_;
  const Blocks& blocks_;
  std::vector<bool> reached_, held_;
};

/// A constraint, or a side of a triangle of fabric.
struct Join {
  std::uint32_t a = 0, b = 0;
  double length = 0;
};

std::vector<Join> joins_of(const Model& model) {
  std::vector<Join> joins;
  const auto add = [&](std::uint32_t a, std::uint32_t b, double length) {
    joins.push_back({a, b, length});
  };
  const ConstraintStore& s = model.constraints;
  for (std::size_t c = 0; c < s.size(); ++c) add(s.a[c], s.b[c], s.rest_length[c]);
  model.membrane.for_each_side(add);
  return joins;
}

/// Along joins from the nearest of some particles, nearest by their number, to the farthest.
struct Way {
  double joins = 0;
  double length = 0;  // m
  std::uint32_t end = kNoIndex;
};

Way longest_way(const Model& model, std::span<const Join> joins,
                std::span<const std::uint32_t> from) {
  const Lists at = make_lists(model.slots(), [&](auto&& add) {
    for (std::uint32_t i = 0; i < joins.size(); ++i) {
      add(joins[i].a, i);
      add(joins[i].b, i);
    }
  });
  std::vector<Way> way(model.slots(), {-1, 0});
  std::vector<std::uint32_t> queue;
  for (const std::uint32_t slot : from) {
    way[slot] = {};
    queue.push_back(slot);
  }
  Way longest;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const Way here = way[queue[i]];
    longest = {here.joins, std::max(longest.length, here.length), queue[i]};
    for (const std::uint32_t k : at[queue[i]]) {
      const std::uint32_t other = joins[k].a == queue[i] ? joins[k].b : joins[k].a;
      if (way[other].joins >= 0) continue;
      way[other] = {here.joins + 1, here.length + joins[k].length};
      queue.push_back(other);
    }
  }
  return longest;
}

/// From where the cloth is held to what is farthest from there. Where no pin holds it, it may come
/// to lie on a sphere by its middle: half of the way across, which two searches find (of several
/// pieces, across the one of the first join).
Way way_that_hangs(const Model& model, std::span<const Join> joins,
                   std::span<const std::uint32_t> anchored) {
  const bool is_held = !model.holds.empty() || !anchored.empty();
  if (is_held || joins.empty() || !model.has_contacts()) {
    std::vector<std::uint32_t> from = model.pins;
    from.insert(from.end(), anchored.begin(), anchored.end());
    return longest_way(model, joins, from);
  }
  const Way out = longest_way(model, joins, std::span(&joins.front().a, 1));
  const Way across = longest_way(model, joins, std::span(&out.end, 1));
  return {across.joins / 2, across.length / 2};
}

/// That of the class which has the median element.
double median_stiffness(const BendingLayout& bending) {
  std::uint32_t lanes = 0;
  for (const BendingClass& c : bending.classes) {
    lanes += bending.last_lane(c) - bending.first_lane(c);
    if (2 * lanes >= bending.element.size()) return c.stiffest;
  }
  return 0;
}

}  // namespace

SmallStepsLoad find_load(const Model& model, const SmallStepsLayout& layout) {
  SmallStepsLoad load;
  load.bending = median_stiffness(layout.bending);
  std::vector<Join> joins = joins_of(model);
  for (const Join& join : joins) load.mean_length += join.length;
  load.mean_length /= static_cast<double>(std::max<std::size_t>(1, joins.size()));
  for (std::size_t i = 0; i < model.seams.size(); ++i)
    joins.push_back({model.seams.a[i], model.seams.b[i], 0});
  const std::vector<std::uint32_t> anchored = anchors_that_hold(model, load.mean_length);
  const Blocks blocks = find_blocks(model, layout, anchored);
  const Way way = way_that_hangs(model, joins, anchored);
  load.particles = Levels(model, blocks).carried();
  const bool has_ropes =
      std::ranges::any_of(layout.batches, [](const EdgeBatch& batch) { return batch.rope; });
  const bool is_by_ways = (!layout.has_yarns() && !layout.blocks.empty()) || has_ropes ||
                          (model.holds.empty() && !model.has_attached());
  load.way = std::max(load.particles, way.joins - 1);
  if (is_by_ways) load.particles = load.way;
  load.reach = way.length;
  std::vector<bool> holds(model.slots());
  for (const auto* slots : {&model.pins, &anchored}) {
    for (const std::uint32_t slot : *slots) holds[slot] = true;
  }
  for_each_yarn(layout.yarns, [&](std::span<const std::uint32_t> links) {
    add_spans(model, holds, links, load);
  });
  return load;
}

double substep_length(const SmallStepsLoad& load, kernels::VectorsView x, double acceleration,
                      double weights, double tolerance) {
  double over_slope = 1;
  for (const SmallStepsLoad::Span& span : load.spans) {
    const double distance = length(x[span.first_slot] - x[span.last_slot]);
    const double slack = std::max(0.0, span.length / distance - 1) + tolerance;
    over_slope = std::max(over_slope, 1 / std::sqrt(6 * slack));
  }
  const auto length_for = [&](double particles, double of_weights) {
    const double pull = 2 * of_weights * acceleration * particles * over_slope;
    return pull > 0 ? std::sqrt(tuning::kOmega * tolerance * load.mean_length / pull)
                    : std::numeric_limits<double>::infinity();
  };
  const double speed = std::sqrt(2 * acceleration * load.reach);
  double h = length_for(load.particles, weights);
  if (speed > 0) h = std::min(h, tuning::kPassing * load.mean_length / speed);
  if (load.bending > 0) {
    const double bent = std::sqrt(tuning::kBendingPace / load.bending);
    h = std::min(h, std::max(bent, length_for(2 * load.way, kWeightsOfSwing)));
  }
  return h;
}

}  // namespace weft
