/// How cloth is joined, for a view that teaches it: its constraints, the yarns that they make, and
/// the colours by which a sweep takes them.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstdint>
#include <span>

#include "tools/program/viewer/sections.h"

namespace weft::tools {

/// Appends these lists. -1 stands for none.
///
///   link ends         two particles of each constraint
///   link colours      constraints of one colour share no particle
///   link yarns        the chain of constraints that each belongs to, diagonals of cells left out
///   link families     no two yarns of a family meet
///   fabric triangles  three particles of each triangle of fabric
///   fabric colours    likewise
void add_structure(Sections& sections, const SceneDescription& scene, const Model& model,
                   std::span<const std::array<std::uint32_t, 4>> cells);

}  // namespace weft::tools
