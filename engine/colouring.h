/// Colours for constraints: no particle has two constraints of the same colour.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace weft {

struct Pair {
  std::uint32_t a, b;
};

struct Colouring {
  std::vector<std::uint32_t> colour;  // per pair
  std::uint32_t count = 0;
};

/// Greedy: pairs in the given order take the lowest colour free at both ends. Uses at most
/// degree(a) + degree(b) - 1 colours, on grids of structural edges 4.
Colouring colour_pairs(std::span<const Pair> pairs, std::size_t particles);

}  // namespace weft
