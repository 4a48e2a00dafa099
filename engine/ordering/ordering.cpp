#include "engine/ordering/ordering.h"

#include <algorithm>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/ordering/batching.h"
#include "engine/ordering/incidence.h"
#include "engine/ordering/lattice.h"
#include "engine/ordering/placement.h"
#include "engine/ordering/tiled_links.h"
#include "engine/ordering/yarns.h"

namespace weft {
namespace {

class Assembly {
 public:
  Assembly(const Placement& placement, std::span<const Link> links, std::size_t particles)
      : placement_(placement), links_(links), tiled_(placement, links, particles) {
    for (std::uint32_t t = 0; t < placement.tiles.size(); ++t) add_tile(t);
    ordering_.between_tiles = static_cast<std::uint32_t>(ordering_.batches.size());
    number_slots(particles);
    add_between_tiles();
    ordering_.colours = tiled_.colours;
    const auto count = static_cast<double>(links.size());
    ordering_.run_share = links.empty() ? 1 : static_cast<double>(links_in_runs_) / count;
  }
  Ordering ordering() && { return std::move(ordering_); }

 private:
  void add_tile(std::uint32_t t) {
    std::vector<std::uint32_t> particle_at = placement_.tiles[t];
    Tile tile;
    tile.first_slot = static_cast<std::uint32_t>(ordering_.slots());
    tile.first_batch = static_cast<std::uint32_t>(ordering_.batches.size());
    Batcher batcher(particle_at);
    const auto slot = [&](std::uint32_t particle) { return tiled_.place_of[particle].slot; };
    add_batches(tiled_.within[t], slot, batcher, tile.first_slot);
    fill_lanes(particle_at);
    ordering_.particle_at.insert(ordering_.particle_at.end(), particle_at.begin(),
                                 particle_at.end());
    tile.last_slot = static_cast<std::uint32_t>(ordering_.slots());
    tile.last_batch = static_cast<std::uint32_t>(ordering_.batches.size());
    ordering_.tiles.push_back(tile);
  }

  void add_between_tiles() {
    Batcher batcher(ordering_.particle_at);
    const auto slot = [&](std::uint32_t particle) { return ordering_.slot_of[particle]; };
    add_batches(tiled_.between, slot, batcher, 0);
    fill_lanes(ordering_.particle_at);
  }

  static void fill_lanes(std::vector<std::uint32_t>& particle_at) {
    while (particle_at.size() % kLanes != 0) particle_at.push_back(kNoIndex);
  }

  void number_slots(std::size_t particles) {
    ordering_.slot_of.assign(particles, kNoIndex);
    for (std::uint32_t slot = 0; slot < ordering_.slots(); ++slot) {
      const std::uint32_t particle = ordering_.particle_at[slot];
      if (particle != kNoIndex) ordering_.slot_of[particle] = slot;
    }
  }

  /// Adds one batch for each kind and colour.
  template <class Slot>
  void add_batches(std::vector<std::uint32_t>& members, const Slot& slot, Batcher& batcher,
                   std::uint32_t first_slot) {
    const auto key = [&](std::uint32_t i) { return std::pair(links_[i].kind, tiled_.colour[i]); };
    std::stable_sort(members.begin(), members.end(),
                     [&](std::uint32_t i, std::uint32_t k) { return key(i) < key(k); });
    for (std::size_t i = 0; i < members.size();) {
      const auto [kind, colour] = key(members[i]);
      std::vector<Joint> joints;
      for (; i < members.size() && key(members[i]) == std::pair(kind, colour); ++i) {
        const Link& link = links_[members[i]];
        const auto [a, b] = std::minmax({slot(link.a), slot(link.b)});
        joints.push_back({a, b, members[i]});
      }
      append(batcher.plan(std::move(joints), placement_.has_runs), colour, kind, first_slot);
    }
  }

  void append(const PlannedBatch& plan, std::uint32_t colour, ConstraintKind kind,
              std::uint32_t first_slot) {
    Batch batch;
    batch.first = static_cast<std::uint32_t>(ordering_.constraint_slots());
    batch.singles = batch.first + plan.singles;
    batch.first_run = static_cast<std::uint32_t>(ordering_.runs.size());
    batch.colour = colour;
    batch.kind = kind;
    for (const Run& run : plan.runs) {
      ordering_.runs.push_back(
          {first_slot + run.a, first_slot + run.b, batch.first + run.constraint, run.length});
    }
    for (const Joint& joint : plan.joints) {
      ordering_.a.push_back(first_slot + joint.a);
      ordering_.b.push_back(first_slot + joint.b);
      ordering_.link_at.push_back(joint.link);
    }
    batch.last = static_cast<std::uint32_t>(ordering_.constraint_slots());
    batch.last_run = static_cast<std::uint32_t>(ordering_.runs.size());
    ordering_.batches.push_back(batch);
    links_in_runs_ += plan.links_in_runs;
  }

  const Placement& placement_;
  std::span<const Link> links_;
  TiledLinks tiled_;
  Ordering ordering_;
  std::size_t links_in_runs_ = 0;
};

/// Only links along the frequent steps of the lattice make runs.
bool may_be_woven(const Placement& placement, double least_run_share) {
  const std::vector<std::uint32_t>& classes = placement.colour_class;
  const auto irregular = std::count(classes.begin(), classes.end(), kNoIndex);
  const auto count = static_cast<double>(classes.size());
  return count - static_cast<double>(irregular) >= least_run_share * count;
}

}  // namespace

std::size_t Ordering::bytes() const {
  return bytes_of(slot_of) + bytes_of(particle_at) + bytes_of(link_at) + bytes_of(a) + bytes_of(b) +
         bytes_of(runs) + bytes_of(batches) + bytes_of(tiles);
}

Ordering order(std::span<const Vec3> positions, std::span<const Link> links,
               std::span<const Link> sides, const OrderingOptions& options) {
  const auto assemble = [&](const Placement& placement) {
    return Assembly(placement, links, positions.size()).ordering();
  };
  if (sides.size() <= links.size()) {
    const std::vector<Cell> cells = find_lattice(positions, find_yarns(positions, links));
    const Placement rows = place_woven(cells, links, options.tile_particles);
    if (may_be_woven(rows, options.least_run_share)) {
      Ordering woven = assemble(rows);
      if (woven.run_share >= options.least_run_share) return woven;
    }
  }
  std::vector<Link> all(links.begin(), links.end());
  all.insert(all.end(), sides.begin(), sides.end());
  const Lists incidence = links_at(positions.size(), all);
  return assemble(place_nearby(incidence, all, options.tile_particles));
}

}  // namespace weft
