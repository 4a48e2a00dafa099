/// The layout of a model for the reference: which constraints are adjacent
/// (kernels/reference/relax.h).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/lists.h"
#include "kernels/reference/relax.h"

namespace weft {

class Model;

struct ReferenceLayout {
  Lists adjacent;                        // constraints at each slot
  Lists rows;                            // per plain constraint: those that share a slot, no hub
  std::vector<std::uint32_t> row_later;  // first entry of the row beyond the constraint itself
  std::vector<double> row_weight;        // s w_p of each entry
  std::vector<std::uint8_t> plain_colour;
  std::vector<std::uint32_t> block_first, block_of;  // blocks of plain constraints of one colour
  Lists block_neighbours;
  const std::uint8_t* hub = nullptr;  // the model's

  reference::Topology topology() const;
  std::size_t bytes() const;
};

ReferenceLayout make_reference_layout(const Model& model);

}  // namespace weft
