#include "engine/solvers/small_steps/creases.h"

#include <algorithm>
#include <numeric>

namespace weft {
namespace {

/// Per element: how many before it are over the same particles.
std::vector<std::uint32_t> layers_of(const BendingStore& bending) {
  std::vector<std::uint32_t> order(bending.size()), layers(bending.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return bending.slots[i]; });
  for (std::size_t k = 1; k < order.size(); ++k) {
    const bool is_same = bending.slots[order[k]] == bending.slots[order[k - 1]];
    layers[order[k]] = is_same ? layers[order[k - 1]] + 1 : 0;
  }
  return layers;
}

}  // namespace

/// An edge's end without a weight has no share: a yarn crosses the edge at its other end.
CreaseLayout make_crease_layout(const Model& model) {
  CreaseLayout layout;
  const BendingStore& bending = model.bending;
  if (!bending.may_yield()) return layout;
  const std::vector<std::uint32_t> layers = layers_of(bending);
  std::vector<std::uint32_t> numbers(
      (std::size_t{1} + *std::ranges::max_element(layers)) * model.slots(), kNoIndex);
  for (std::uint32_t i = 0; i < bending.size(); ++i) {
    const reference::BendingElement e = element_of(bending, i);
    const double inverse_mass = inverse_mass_of(e, model.inverse_mass.data());
    if (!e.yields || !(inverse_mass > 0)) continue;
    const double size = std::abs(e.weights[0]) + std::abs(e.weights[1]);
    const double first = size > 0 ? std::abs(e.weights[0]) / size : 0.5;
    CreaseLayout::Hinge hinge{i, {}, {first, 1 - first}, e.compliance / inverse_mass};
    const double yield = bending.yielding[i].yield, most = 0.5 * yield * yield / e.compliance;
    for (std::size_t k = 0; k < 2; ++k) {
      std::uint32_t& number = numbers[layers[i] * model.slots() + e.slots[k]];
      if (number == kNoIndex) {
        number = static_cast<std::uint32_t>(layout.capacity.size());
        layout.capacity.push_back(0);
      }
      hinge.place[k] = number;
      layout.capacity[number] += hinge.share[k] * most;
    }
    layout.hinges.push_back(hinge);
  }
  return layout;
}

}  // namespace weft
