#include "engine/solvers/small_steps/bending_arms.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "engine/lists.h"
#include "engine/model/bending_element.h"
#include "engine/model/model.h"
#include "engine/tuning.h"
#include "kernels/reference/bending.h"

namespace weft {
namespace {

/// Per slot: what a constraint or a triangle of fabric joins it to.
Lists joins_of_slots(const Model& model) {
  return make_lists(model.slots(), [&](auto&& add) {
    for (std::size_t c = 0; c < model.constraints.size(); ++c) {
      add(model.constraints.a[c], model.constraints.b[c]);
      add(model.constraints.b[c], model.constraints.a[c]);
    }
    for (const auto& [a, b, c] : model.membrane.slots) {
      for (const std::uint32_t other : {b, c}) add(a, other);
      for (const std::uint32_t other : {a, c}) add(b, other);
      for (const std::uint32_t other : {a, b}) add(c, other);
    }
  });
}

/// Two joins away from the middle: noise by single particles has the same sign there.
std::optional<std::uint32_t> slot_beside(const Model& model,
                                         const reference::BendingElement& element,
                                         const Lists& joins) {
  const auto order = reference::order_of_arms(element);
  const auto at = [&](std::uint32_t slot) { return model.initial_position[slot]; };
  const kernels::Vector middle = at(element.slots[order[1]]);
  const kernels::Vector along = at(element.slots[order[0]]) - at(element.slots[order[2]]);
  const double size = length(along);
  std::optional<std::uint32_t> best;
  double most = 0;
  const auto look_at = [&](std::uint32_t slot) {
    if (std::ranges::count(element.slots, slot) > 0) return;
    const kernels::Vector away = at(slot) - middle;
    const double across = length(cross(away, along)), sine = across / (length(away) * size);
    if (!(sine > tuning::kLeastSineBeside) || !(across * sine > most)) return;
    most = across * sine;
    best = slot;
  };
  for (const std::uint32_t next : joins[element.slots[order[1]]]) {
    for (const std::uint32_t slot : joins[next]) look_at(slot);
  }
  return best;
}

}  // namespace

std::vector<std::optional<std::uint32_t>> particles_beside(const Model& model) {
  const BendingStore& store = model.bending;
  std::vector<std::optional<std::uint32_t>> beside(store.size());
  const Lists joins = joins_of_slots(model);
  for (std::size_t i = 0; i < store.size(); ++i) {
    const reference::BendingElement element = element_of(store, i);
    if (!has_three(element)) continue;
    beside[i] = slot_beside(model, element, joins);
  }
  return beside;
}

}  // namespace weft
