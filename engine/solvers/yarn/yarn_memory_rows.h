/// The family of yarns that is in place: the rows of its blocks are the rows of memory.
///
/// Woven slots (engine/ordering) follow the rows of a sheet, so that the yarns across these rows
/// are adjacent: kLanes of them have, in each row, kLanes consecutive slots, or groups of four
/// consecutive slots. These become the rows of memory. All other particles are stored behind them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/model/model.h"
#include "engine/solvers/yarn/yarn_layout.h"
#include "engine/solvers/yarn/yarn_places.h"

namespace weft {

/// The slots of a layout whose blocks are in quads, while it is being woven.
struct SlotRows {
  using Slots = std::span<const std::uint32_t>;

  const Model& model;
  const YarnLayout& layout;

  /// The kLanes slots of a row of the layout.
  Slots of(std::size_t row) const {
    return Slots(layout.slot).subspan(row * kernels::kLanes, kernels::kLanes);
  }
  /// Whether the slot is of the model, and not the padding of a lane without a yarn.
  bool real(std::uint32_t slot) const { return slot < model.slots(); }
  std::uint32_t count(Slots slots) const {
    return static_cast<std::uint32_t>(
        std::ranges::count_if(slots, [&](std::uint32_t slot) { return real(slot); }));
  }
};

struct YarnHome {
  std::size_t family = 0;
  YarnPlaces places;     // without `floats`, since the caller may add rows to memory
  std::size_t rows = 0;  // the rows of memory so far
};

/// Finds the family with the most particles in rows of fours, and the place of every particle if it
/// is in place. Returns nothing if it has too few.
std::optional<YarnHome> find_home(const SlotRows& slots);

}  // namespace weft
