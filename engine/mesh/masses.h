/// Masses from areas.
#pragma once

#include <vector>

#include "engine/mesh/faces.h"

namespace weft::mesh {

/// Per particle: the density times what is its of each face (corner_areas).
std::vector<double> masses_of(const std::vector<Face>& faces, double density,
                              std::size_t particles);
/// Half the mass of each thread to either end. density: kg/m.
void add_masses(const std::vector<Constraint>& threads, double density,
                std::vector<double>& masses);

}  // namespace weft::mesh
