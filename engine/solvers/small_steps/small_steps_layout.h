/// The layout of a model for small steps (engine/solvers/small_steps/small_steps.h): its
/// constraints as blocks, in the order of a sweep, and the places of their particles.
///
///   bending       elements of one colour each, before all constraints
///   linkage       all constraints together, where they are chains, trees and bridges
///   yarn blocks   family by family, where the distance constraints make yarns; in woven rows where
///                 yarns are all there is, else in quads
///   edge blocks   kLanes constraints of one colour each: tile by tile, then between the tiles
///   serial        constraints at hubs, one after the other
///   membrane      triangles of fabric of one colour each
///   anchors       after each family and in the end,
///                 since the effect of one family on an anchored particle must not move those
///                 of the other
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/solvers/small_steps/anchor_layout.h"
#include "engine/solvers/small_steps/bending_layout.h"
#include "engine/solvers/small_steps/linkage_layout.h"
#include "engine/solvers/small_steps/local_items.h"
#include "engine/solvers/small_steps/membrane_layout.h"
#include "engine/solvers/small_steps/small_steps_load.h"
#include "engine/solvers/yarn/yarn_layout.h"
#include "kernels/simd/table.h"

namespace weft {

class Model;
struct ConstraintStore;

/// Edge blocks of one kind that share no particle.
struct EdgeBatch {
  std::uint32_t first = 0, last = 0;
  bool rope = false;
};

/// Batches first ... last - 1 of a tile.
struct EdgeTile {
  std::uint32_t first = 0, last = 0;
};

struct SmallStepsLayout {
  YarnLayout yarns;  // no blocks: there are none
  std::vector<simd::EdgeBlock> blocks;
  std::vector<std::uint32_t> constraint;  // per edge block and lane, or kNoIndex
  std::vector<std::uint16_t> used;        // per edge block, a bit per lane that has a constraint
  // Of a model with springs only.
  std::vector<simd::SpringBlock> springs;  // per edge block
  /// Per constraint: edge lanes, then serial ones, then rows of yarns.
  std::vector<std::uint32_t> multiplier_place;
  std::vector<EdgeBatch> batches;  // those of each tile, then those between tiles
  std::vector<EdgeTile> tiles;
  std::uint32_t between_tiles = 0;  // first batch
  std::vector<std::uint32_t> serial;
  MembraneLayout membrane;
  BendingLayout bending;
  AnchorLayout anchors;
  LinkageLayout linkage;  // all constraints, or none
  LocalItems items;

  double cell = 0;         // that positions are split by
  std::size_t floats = 0;  // of an array of particles
  SmallStepsLoad load;

  const YarnPlaces& places() const { return yarns.places; }
  bool has_yarns() const { return !yarns.blocks.empty(); }
  /// Whether anything besides yarns is swept.
  bool has_single_constraints() const {
    return !blocks.empty() || !serial.empty() || !membrane.empty();
  }
  std::size_t first_multiplier_of_yarns() const { return constraint.size() + serial.size(); }
  /// 0 without springs.
  std::size_t multipliers() const {
    if (multiplier_place.empty()) return 0;
    return first_multiplier_of_yarns() + yarns.constraint.size();
  }
  std::size_t bytes() const;
};

/// The particles of a yarn, in the order of its constraints.
std::vector<std::uint32_t> slots_of(const ConstraintStore& store,
                                    std::span<const std::uint32_t> links);

/// The compliance of a yarn's constraints in a sweep (kernels/simd/small_step_yarns.h), by which of
/// its particles are fixed.
double compliance_of_yarn(const Model& model, std::span<const std::uint32_t> slots);

/// The constraints of a yarn, from one end to the other.
std::vector<std::uint32_t> links_of(const YarnLayout& yarns, const simd::YarnBlock& block,
                                    std::size_t lane);

/// work(constraints of a yarn), of a family
template <class Work>
void for_each_yarn(const YarnLayout& yarns, std::size_t family, Work&& work) {
  for (std::size_t i = yarns.family_begin[family]; i < yarns.family_begin[family + 1]; ++i) {
    const simd::YarnBlock& block = yarns.blocks[i];
    for (std::size_t lane = 0; lane < block.lanes; ++lane) work(links_of(yarns, block, lane));
  }
}

/// Calls work for the blocks of all families.
template <class Work>
void for_each_yarn(const YarnLayout& yarns, Work&& work) {
  for (std::size_t family = 0; family < yarns.families(); ++family)
    for_each_yarn(yarns, family, work);
}

}  // namespace weft
