/// A woven mesh as a lattice: each particle's row and its place along the row, found by walking
/// the yarns of the two longest families.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <span>
#include <vector>

#include "engine/ordering/yarns.h"

namespace weft {

/// A particle's place. Parts are not comparable with each other; within a part rows and columns
/// start at 0 and no two particles have the same place.
struct Cell {
  std::uint32_t part = kNoIndex;
  std::int32_t row = 0, column = 0;
  auto operator<=>(const Cell&) const = default;
};

/// Every particle gets a cell; one that fits nowhere is a part of its own.
std::vector<Cell> find_lattice(std::span<const Vec3> positions, const WovenYarns& yarns);

}  // namespace weft
