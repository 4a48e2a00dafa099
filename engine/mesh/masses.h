/// Masses from areas.
#pragma once

#include <vector>

#include "engine/mesh/faces.h"

namespace weft::mesh {

/// Per particle: the density times what is its of each face (corner_areas).
std::vector<double> masses_of(const std::vector<Face>& faces, double density,
                              std::size_t particles);

}  // namespace weft::mesh
