/// Triangles of fabric in the order in which small steps visit them: batch by batch, those of one
/// kind first. No two elements of a batch share a particle.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/simd/table.h"

namespace weft {

class Model;

/// Blocks first ... last - 1.
struct MembraneBatch {
  std::uint32_t first = 0, last = 0;
  bool rope = false;
};

struct MembraneLayout {
  std::vector<simd::MembraneBlock> blocks;
  std::vector<std::uint32_t> element;  // per block and lane: in Model::membrane, or kNoIndex
  std::vector<std::uint32_t> place;    // per element: its lane of all blocks
  std::vector<MembraneBatch> batches;

  bool empty() const { return blocks.empty(); }
  std::size_t bytes() const;
};

MembraneLayout make_membrane_layout(const Model& model);

}  // namespace weft
