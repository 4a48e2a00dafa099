/// The items of local passes (local_passes.h), and the places of their bits. They follow from the
/// model alone: the cloths of a model share them.
///
/// An item is a constraint, or a triangle of fabric with its three laws; items are numbered in this
/// order. Each particle has a mask of 64 bits, one for each of its items. A particle with more
/// items has no mask: these have their bits at their other ends or, where none of those has a mask
/// either, nowhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/lists.h"

namespace weft {

class Model;

struct LocalItems {
  static constexpr std::uint32_t kNoBit = 255;

  /// Where an item has its bit.
  struct End {
    std::uint32_t slot = 0;
    std::uint32_t bit = kNoBit;  // its number; kNoBit: the slot has no mask
    std::uint64_t mask() const { return bit == kNoBit ? 0 : std::uint64_t{1} << bit; }
  };

  std::uint32_t constraints = 0;
  std::vector<End> all_ends;            // of constraints two each, of triangles three each
  Lists at;                             // slot -> items
  std::vector<std::uint32_t> unmasked;  // those without a bit

  std::span<const End> ends(std::uint32_t item) const {
    if (item < constraints) return {all_ends.data() + 2 * std::size_t{item}, 2};
    const std::size_t element = item - constraints;
    return {all_ends.data() + 2 * std::size_t{constraints} + 3 * element, 3};
  }
  std::size_t bytes() const;
};

LocalItems make_local_items(const Model& model);

}  // namespace weft
