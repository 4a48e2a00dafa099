/// Lengths at rest of the edges of a cloth's surface.
#pragma once

#include <vector>

#include "engine/gaps.h"
#include "engine/model/model.h"

namespace weft {

/// m, per edge of the surface: what a constraint or a triangle of fabric says, or else what it has
/// where the cloth begins.
std::vector<double> lengths_at_rest(const Model& model, const TriangleSurface& surface);

/// At rest.
Gaps widest_gaps(const Model& model);

}  // namespace weft
