/// The family of yarns that is in place: its blocks' rows are the rows of memory.
///
/// Woven slots (engine/ordering) follow the rows of a sheet, so that yarns across these stand side
/// by side: kLanes of them, row by row, are kLanes slots in a row each time, or fours of slots.
/// They make the rows of memory. All other particles stand behind them.
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

  /// Of a row of the layout: kLanes of them.
  Slots of(std::size_t row) const {
    return Slots(layout.slot).subspan(row * kernels::kLanes, kernels::kLanes);
  }
  /// Or of a lane without a yarn.
  bool real(std::uint32_t slot) const { return slot < model.slots(); }
  std::uint32_t count(Slots slots) const {
    return static_cast<std::uint32_t>(
        std::ranges::count_if(slots, [&](std::uint32_t slot) { return real(slot); }));
  }
};

struct YarnHome {
  std::size_t family = 0;
  YarnPlaces places;     // floats is left to those who add rows to memory
  std::size_t rows = 0;  // of memory
};

/// The family that has most particles in rows of fours, and where all particles are then; none if
/// these are too few.
std::optional<YarnHome> find_home(const SlotRows& slots);

}  // namespace weft
