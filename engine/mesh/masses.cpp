#include "engine/mesh/masses.h"

namespace weft::mesh {

std::vector<double> masses_of(const std::vector<Face>& faces, double density,
                              std::size_t particles) {
  std::vector<double> masses(particles, 0);
  for (const Face& face : faces) {
    const auto areas = corner_areas(face);
    for (std::size_t i = 0; i < face.size; ++i) masses[face.particles[i]] += density * areas[i];
  }
  return masses;
}

}  // namespace weft::mesh
