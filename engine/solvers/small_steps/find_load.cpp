#include "engine/solvers/small_steps/find_load.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/erase_repeated.h"
#include "engine/lists.h"
#include "engine/model/model.h"
#include "engine/model/nearest.h"
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

/// Anchored particles that cloth may hang on, and those that slide on a rail which stands: a limit
/// that is wider than another by more than a constraint is long is slack where that holds. A pin is
/// a limit of 0.
std::vector<std::uint32_t> anchors_that_hold(const Model& model, double mean_length) {
  const AnchorStore& anchors = model.anchors;
  double least = model.holds.empty() ? std::numeric_limits<double>::infinity() : 0;
  for (const reference::AnchorLimits& limits : anchors.limits) least = std::min(least, limits.most);
  std::vector<std::uint32_t> slots;
  for (std::size_t i = 0; i < anchors.described.size(); ++i) {
    if (anchors.limits[i].most <= least + mean_length && std::isfinite(anchors.limits[i].most))
      slots.push_back(anchors.slot[i]);
  }
  for (std::size_t i = 0; i < model.sliders.size() && mean_length > 0; ++i) {
    if (model.inverse_mass[model.sliders.rail[model.sliders.first[i]]] == 0)
      slots.push_back(model.sliders.slot[i]);
  }
  return slots;
}

/// Adds the spans of the yarn, between each particle that holds and the next.
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

/// Per constraint: whether it is a rope that joins a pin to a particle past others, being longer
/// than another constraint of that particle by half.
std::vector<bool> find_tethers(const Model& model) {
  const ConstraintStore& s = model.constraints;
  std::vector<bool> tethers(s.size());
  std::vector<double> shortest(model.slots(), std::numeric_limits<double>::infinity());
  for (std::size_t c = 0; c < s.size(); ++c) {
    for (const std::uint32_t slot : {s.a[c], s.b[c]})
      shortest[slot] = std::min(shortest[slot], s.rest_length[c]);
  }
  for (std::size_t c = s.bilateral; c < s.size(); ++c) {
    const bool from_pin = model.inverse_mass[s.a[c]] == 0 || model.inverse_mass[s.b[c]] == 0;
    const std::uint32_t end = model.inverse_mass[s.a[c]] == 0 ? s.b[c] : s.a[c];
    tethers[c] = from_pin && s.rest_length[c] > 1.5 * shortest[end];
  }
  return tethers;
}

/// One block carries whatever hangs on it.
std::vector<std::uint32_t> slots_of_linkage(const ConstraintStore& s) {
  std::vector<std::uint32_t> slots(s.a);
  slots.insert(slots.end(), s.b.begin(), s.b.end());
  std::ranges::sort(slots);
  erase_repeated(slots);
  return slots;
}

Blocks find_blocks(const Model& model, const SmallStepsLayout& layout,
                   std::span<const std::uint32_t> anchored, const std::vector<bool>& tethers) {
  Blocks blocks;
  const ConstraintStore& s = model.constraints;
  const auto add = [&](std::uint32_t c) {
    if (c != kNoIndex && !tethers[c]) blocks.slots_of.push_back(std::vector{s.a[c], s.b[c]});
  };
  for_each_yarn(layout.yarns, [&](std::span<const std::uint32_t> links) {
    blocks.slots_of.push_back(slots_of(s, links));
  });
  if (!layout.linkage.empty()) blocks.slots_of.push_back(slots_of_linkage(s));
  std::ranges::for_each(layout.constraint, add);
  std::ranges::for_each(layout.serial, add);
  for (const auto& corners : model.membrane.slots) blocks.slots_of.push_back(std::span(corners));
  for (std::size_t i = 0; i < model.seams.size(); ++i) {
    if (!model.seams.is_broken(i))
      blocks.slots_of.push_back(std::vector{model.seams.a[i], model.seams.b[i]});
  }
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
  /// own: the share that a sweep leaves of the particles of a block itself.
  Levels(const Model& model, const Blocks& blocks, double own)
      : model_(model),
        blocks_(blocks),
        own_(own),
        reached_(blocks.slots_of.size()),
        held_(model.slots()) {}

  /// kg, of the particles on blocks at pins, after carried().
  double held_mass() const { return first_mass_; }
  /// Particles on a block at a pin; 0: nothing is at a pin.
  double carried() {
    std::vector<std::uint32_t> level, next;
    for (std::uint32_t i = 0; i < reached_.size(); ++i) {
      if (is_pinned(i)) reach(i, level);
    }
    double mass = 0, depth = 0;
    for (; !level.empty(); level.swap(next)) {
      next.clear();
      double held = 0;
      for (const std::uint32_t i : level) held += hold(i, next);
      if (held > 0) ++depth;
      mass += held;
      if (first_mass_ == 0) first_mass_ = mass;
    }
    return depth == 0 ? 0 : std::max(mass / first_mass_, depth) - 1 + own_;
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
  const double own_;
  std::vector<bool> reached_, held_;
  double first_mass_ = 0;
};

std::vector<Join> joins_of(const Model& model, const std::vector<bool>& tethers) {
  std::vector<Join> joins;
  const auto add = [&](std::uint32_t a, std::uint32_t b, double length) {
    joins.push_back({a, b, length});
  };
  const ConstraintStore& s = model.constraints;
  for (std::size_t c = 0; c < s.size(); ++c) {
    if (!tethers[c]) add(s.a[c], s.b[c], s.rest_length[c]);
  }
  model.membrane.for_each_side(add);
  return joins;
}

double mean_length(std::span<const Join> joins) {
  double sum = 0;
  for (const Join& join : joins) sum += join.length;
  return sum / static_cast<double>(std::max<std::size_t>(1, joins.size()));
}

void add_seams(const Model& model, std::vector<Join>& joins) {
  for (std::size_t i = 0; i < model.seams.size(); ++i) {
    if (!model.seams.is_broken(i)) joins.push_back({model.seams.a[i], model.seams.b[i], 0});
  }
}

/// Along joins from the nearest of some particles, nearest by their number, to the farthest.
struct Way {
  double joins = 0;
  double length = 0;  // m
  std::uint32_t end = kNoIndex;
  std::size_t reached = 0;  // particles
};

Way longest_way(const Model& model, std::span<const Join> joins,
                std::span<const std::uint32_t> from) {
  const Lists at = joins_at(model.slots(), joins);
  std::vector<Way> way(model.slots(), {-1, 0});
  std::vector<std::uint32_t> queue;
  for (const std::uint32_t slot : from) {
    way[slot] = {};
    queue.push_back(slot);
  }
  Way longest;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const Way here = way[queue[i]];
    longest = {here.joins, std::max(longest.length, here.length), queue[i], i + 1};
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
  if (is_held || joins.empty() || !model.has_spheres()) {
    std::vector<std::uint32_t> from = model.pins;
    from.insert(from.end(), anchored.begin(), anchored.end());
    return longest_way(model, joins, from);
  }
  const Way out = longest_way(model, joins, std::span(&joins.front().a, 1));
  const Way across = longest_way(model, joins, std::span(&out.end, 1));
  return {across.joins / 2, across.length / 2, across.end, across.reached};
}

/// Where all that hangs does so without them.
void leave_tethers_out(const Model& model, std::span<const std::uint32_t> anchored,
                       std::vector<bool>& tethers, std::vector<Join>& joins, Way& way) {
  const std::vector<bool> found = find_tethers(model);
  if (std::ranges::count(found, true) == 0) return;
  std::vector<Join> without = joins_of(model, found);
  add_seams(model, without);
  const Way other = way_that_hangs(model, without, anchored);
  if (other.reached < way.reached) return;
  tethers = found;
  joins = std::move(without);
  way = other;
}

/// Constraints that cannot become longer: rigid ones, and ropes without a compliance.
std::vector<Join> rigid_joins(const ConstraintStore& s) {
  std::vector<Join> joins;
  for (std::uint32_t c = 0; c < s.size(); ++c) {
    if (!s.has_springs() || s.compliance[c] == 0)
      joins.push_back({s.a[c], s.b[c], s.rest_length[c]});
  }
  return joins;
}

/// Between pins whose nearest particles meet: what is out of reach of a pin is out of reach of one
/// of these, too, or of several on the way.
std::vector<SmallStepsLoad::Span> find_ways(const Model& model) {
  std::vector<SmallStepsLoad::Span> ways;
  if (model.holds.size() < 2) return ways;
  const std::vector<Join> joins = rigid_joins(model.constraints);
  const std::vector<Nearest> nearest = find_nearest(model.slots(), model.holds, joins);
  for (const auto& [a, b, length] : joins) {
    const std::uint32_t first = nearest[a].end, last = nearest[b].end;
    if (first == last || first == kNoIndex || last == kNoIndex) continue;
    ways.push_back({std::min(first, last), std::max(first, last),
                    nearest[a].length + length + nearest[b].length});
  }
  const auto key = [](const SmallStepsLoad::Span& way) {
    return std::tuple(way.first_slot, way.last_slot, way.length);
  };
  const auto pins = [](const SmallStepsLoad::Span& way) {
    return std::pair(way.first_slot, way.last_slot);
  };
  std::ranges::sort(ways, {}, key);
  erase_repeated(ways, pins);
  ways.shrink_to_fit();
  return ways;
}

}  // namespace

SmallStepsLoad find_load(const Model& model, const SmallStepsLayout& layout) {
  SmallStepsLoad load;
  std::vector<bool> tethers(model.constraints.size());
  std::vector<Join> joins = joins_of(model, tethers);
  const std::vector<std::uint32_t> anchored = anchors_that_hold(model, mean_length(joins));
  add_seams(model, joins);
  Way way = way_that_hangs(model, joins, anchored);
  leave_tethers_out(model, anchored, tethers, joins, way);
  load.mean_length = mean_length(joins_of(model, tethers));
  const Blocks blocks = find_blocks(model, layout, anchored, tethers);
  Levels levels(model, blocks, layout.linkage.empty() ? (1 - tuning::kOmega) / 2 : 0);
  load.particles = levels.carried();
  load.held_mass = levels.held_mass();
  const bool has_ropes = std::ranges::any_of(layout.constraint, [&](std::uint32_t c) {
    return c != kNoIndex && c >= model.constraints.bilateral && !tethers[c];
  });
  const bool has_edges = !layout.has_yarns() && !layout.blocks.empty();
  const bool hangs = !model.holds.empty() || model.has_attached();
  const bool is_by_ways = has_edges || has_ropes || !hangs;
  if (is_by_ways) load.particles = std::max(load.particles, way.joins - 1);
  load.reach = layout.linkage.empty() ? way.length : 0;
  load.ways = find_ways(model);
  std::vector<bool> holds(model.slots());
  for (const auto* slots : {&model.pins, &anchored}) {
    for (const std::uint32_t slot : *slots) holds[slot] = true;
  }
  for_each_yarn(layout.yarns, [&](std::span<const std::uint32_t> links) {
    add_spans(model, holds, links, load);
  });
  return load;
}

}  // namespace weft
