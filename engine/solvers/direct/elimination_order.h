/// The order in which the rows of a sparse symmetric matrix are eliminated.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/lists.h"

namespace weft {

/// Little fill-in, by approximate minimum degree, and in postorder. neighbours: for each row, the
/// rows with which it has an entry, without itself; fewer than 2^31 rows and entries.
std::vector<std::uint32_t> elimination_order(const Lists& neighbours);

/// The same lists where row i is the one that was order[i].
Lists in_order(const Lists& neighbours, const std::vector<std::uint32_t>& order);

}  // namespace weft
