/// Where the particles go: the first half of making an Ordering.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <span>
#include <vector>

#include "engine/ordering/incidence.h"
#include "engine/ordering/lattice.h"
#include "engine/ordering/ordering.h"

namespace weft {

struct Placement {
  std::vector<std::vector<std::uint32_t>> tiles;  // particle of each slot, kNoIndex: padding
  /// Per link: a number that links of the same colour share, kNoIndex where any free colour does.
  /// Classes 2 k and 2 k + 1 alternate along the same direction of the lattice.
  std::vector<std::uint32_t> colour_class;
  bool has_runs = false;
};

/// Rows of the lattice, tile after tile, so that links between neighbours make runs.
Placement place_woven(std::span<const Cell> cells, std::span<const Link> links,
                      std::uint32_t tile_particles);

/// Compact tiles of any mesh, neighbours near each other; no runs.
Placement place_nearby(const Lists& incidence, std::span<const Link> links,
                       std::uint32_t tile_particles);

/// How many tiles to cut: two threads want two at least, and an even number.
std::uint32_t tile_count(std::size_t particles, std::uint32_t tile_particles);

}  // namespace weft
