/// Groups of particles side by side in memory, for contacts with bodies.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/solvers/yarn/yarn_places.h"
#include "kernels/simd/table.h"

namespace weft {

class Model;

/// Blocks of kLanes places with at least one particle that is free.
struct BodyLayout {
  kernels::AlignedVector<simd::BodyBlock> blocks;
  std::vector<std::uint32_t> slot_at;   // per block and lane; kNoIndex: none that is free
  std::vector<std::uint32_t> place_of;  // per slot: block * kLanes + lane, or kNoIndex
  std::size_t bytes() const;
};

/// far: of the shortest constraint of a particle, the share that it may be moved without its
/// constraints being looked at.
BodyLayout make_body_layout(const Model& model, const YarnPlaces& places, double far);

/// m, per slot: of its constraints and of the sides of its triangles of fabric.
std::vector<double> shortest_lengths(const Model& model);

}  // namespace weft
