/// The order of particles and constraints in memory, in which loops over them are contiguous.
///
///   slots       particles in memory order; some slots are padding and hold no particle
///   tile        a range of slots that fits into the cache of a core; only the constraints between
///               tiles couple them
///   batch       constraints of one colour and one kind within a tile, or between tiles. No slot
///               occurs twice in a batch, padding included, so that its constraints are
///               independent
///   run         consecutive constraints c + k of a batch
///               that join the slots a + k and b + k
///               and need no indices
///   singles     the rest of a batch, whose constraints find their slots through an index
///
/// One pass over the constraints goes through the batches as if in order: tile after tile, where
/// tiles may be handled by different threads, then the batches between tiles one after the other.
///
///   constraint slots of a batch:  | run | run | ... | run | singles |
///                                 ^first                  ^singles  ^last
///
/// The lengths of all runs and of the singles are multiples of kLanes. Padding constraints fill
/// them up; they join slots that the batch does not use otherwise, and move nothing.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <span>
#include <vector>

#include "engine/ordering/incidence.h"
#include "kernels/runs.h"

namespace weft {

using kernels::kLanes;
using kernels::Run;

struct Batch {
  std::uint32_t first = 0, singles = 0, last = 0;  // constraint slots
  std::uint32_t first_run = 0, last_run = 0;       // in Ordering::runs
  std::uint32_t colour = 0;  // unique at each particle; batches between tiles have their own
  ConstraintKind kind = ConstraintKind::distance;
};

struct Tile {
  std::uint32_t first_slot = 0, last_slot = 0;
  std::uint32_t first_batch = 0, last_batch = 0;
};

struct Ordering {
  std::vector<std::uint32_t> slot_of;      // particle -> slot
  std::vector<std::uint32_t> particle_at;  // slot -> particle, kNoIndex: padding
  std::vector<std::uint32_t> link_at;      // constraint slot -> link, kNoIndex: padding
  std::vector<std::uint32_t> a, b;         // constraint slot -> slots; a may be that of link.b
  std::vector<Run> runs;
  std::vector<Batch> batches;
  std::vector<Tile> tiles;
  std::uint32_t between_tiles = 0;  // the first batch between tiles, which come last
  std::uint32_t colours = 0;
  double run_share = 0;  // links in runs / links

  std::size_t slots() const { return particle_at.size(); }
  std::size_t constraint_slots() const { return link_at.size(); }
  std::size_t bytes() const;
};

struct OrderingOptions {
  std::uint32_t tile_particles = 4096;
  /// A mesh with a smaller share of links in runs is ordered for locality alone, and all of its
  /// links are singles.
  double least_run_share = 0.7;
};

/// The result depends on the arguments only. Links must be valid and without duplicates. sides: of
/// triangles that join particles as links do, but are no constraints of a batch. Where there are
/// more of them than links the mesh is ordered for locality alone.
Ordering order(std::span<const Vec3> positions, std::span<const Link> links,
               std::span<const Link> sides = {}, const OrderingOptions& options = {});

}  // namespace weft
