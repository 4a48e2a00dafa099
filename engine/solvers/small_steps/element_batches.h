/// Batches of elements that share no particle, so that lanes and threads may visit those of a batch
/// at once.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "kernels/runs.h"

namespace weft {

/// slots_of(element): a range of its slots, of `slots` that there are. Elements are taken by their
/// first slots, so that a batch goes through memory in one direction; each batch takes all that it
/// can.
template <class SlotsOf>
std::vector<std::vector<std::uint32_t>> batches_of(std::vector<std::uint32_t> elements,
                                                   std::size_t slots, SlotsOf&& slots_of) {
  std::ranges::stable_sort(elements, {},
                           [&](std::uint32_t i) { return std::ranges::min(slots_of(i)); });
  std::vector<std::vector<std::uint32_t>> batches;
  std::vector<std::size_t> batch_of(slots);  // the last one that took the slot: 1, 2, ...
  std::vector<std::uint32_t> later;
  while (!elements.empty()) {
    std::vector<std::uint32_t>& batch = batches.emplace_back();
    const auto is_taken = [&](std::uint32_t slot) { return batch_of[slot] == batches.size(); };
    for (const std::uint32_t i : elements) {
      if (std::ranges::any_of(slots_of(i), is_taken)) {
        later.push_back(i);
        continue;
      }
      for (const std::uint32_t slot : slots_of(i)) batch_of[slot] = batches.size();
      batch.push_back(i);
    }
    elements.swap(later);
    later.clear();
  }
  return batches;
}

/// add_block(elements) for each kLanes of a batch; the last ones may be fewer.
template <class AddBlock>
void for_each_block(std::span<const std::uint32_t> batch, AddBlock&& add_block) {
  for (std::size_t i = 0; i < batch.size(); i += kernels::kLanes)
    add_block(batch.subspan(i, std::min<std::size_t>(kernels::kLanes, batch.size() - i)));
}

}  // namespace weft
