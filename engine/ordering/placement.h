/// The first half of making an Ordering: the places of the particles.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <span>
#include <vector>

#include "engine/ordering/incidence.h"
#include "engine/ordering/lattice.h"

namespace weft {

struct Placement {
  std::vector<std::vector<std::uint32_t>> tiles;  // particle of each slot; kNoIndex in padding
  /// Per link: its colour class, or kNoIndex if it may have any free colour. Classes 2 k and 2 k +
  /// 1 alternate along the same direction of the lattice.
  std::vector<std::uint32_t> colour_class;
  bool has_runs = false;
};

/// Places the rows of the lattice tile after tile, so that links between neighbours make runs.
Placement place_woven(std::span<const Cell> cells, std::span<const Link> links,
                      std::uint32_t tile_particles);

/// Places any mesh in compact tiles with neighbours near each other. There are no runs.
Placement place_nearby(const Lists& incidence, std::span<const Link> links,
                       std::uint32_t tile_particles);

/// The number of tiles. It is even if it is not 1, so that two threads have equal shares.
std::uint32_t tile_count(std::size_t particles, std::uint32_t tile_particles);

}  // namespace weft
