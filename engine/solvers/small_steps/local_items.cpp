#include "engine/solvers/small_steps/local_items.h"

#include <algorithm>

#include "engine/bytes_of.h"
#include "engine/model/model.h"

namespace weft {
namespace {

void add_ends(const Model& model, LocalItems& items) {
  const ConstraintStore& s = model.constraints;
  items.all_ends.reserve(2 * s.size() + 3 * model.membrane.size());
  for (std::uint32_t c = 0; c < s.size(); ++c) {
    items.all_ends.push_back({s.a[c]});
    items.all_ends.push_back({s.b[c]});
  }
  for (const auto& corners : model.membrane.slots) {
    for (const std::uint32_t slot : corners) items.all_ends.push_back({slot});
  }
}

std::uint32_t bit_of(std::span<const std::uint32_t> items_of_slot, std::uint32_t item) {
  if (items_of_slot.size() > 64) return LocalItems::kNoBit;
  return static_cast<std::uint32_t>(std::ranges::find(items_of_slot, item) - items_of_slot.begin());
}

}  // namespace

LocalItems make_local_items(const Model& model) {
  LocalItems items;
  items.constraints = static_cast<std::uint32_t>(model.constraints.size());
  add_ends(model, items);
  const auto count = items.constraints + static_cast<std::uint32_t>(model.membrane.size());
  items.at = make_lists(model.slots(), [&](auto&& add) {
    for (std::uint32_t item = 0; item < count; ++item) {
      for (const LocalItems::End& end : items.ends(item)) add(end.slot, item);
    }
  });
  auto end = items.all_ends.begin();
  for (std::uint32_t item = 0; item < count; ++item) {
    bool has_bit = false;
    for (std::size_t k = items.ends(item).size(); k > 0; --k, ++end) {
      end->bit = bit_of(items.at[end->slot], item);
      has_bit = has_bit || end->bit != LocalItems::kNoBit;
    }
    if (!has_bit) items.unmasked.push_back(item);
  }
  return items;
}

std::size_t LocalItems::bytes() const {
  return bytes_of(all_ends) + at.bytes() + bytes_of(unmasked);
}

}  // namespace weft
