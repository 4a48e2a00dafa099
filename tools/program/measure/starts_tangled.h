/// Cloth that crosses itself when a run begins.
#pragma once

#include <weft/weft.h>

#include <cstddef>

namespace weft::tools {

/// Pairs of triangles of its surface that cross each other and have no corner in common, in the
/// mesh or by a seam. 0 where layers of the cloth do not touch each other.
std::size_t starts_tangled(const SceneDescription& scene);

}  // namespace weft::tools
