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

void add_masses(const std::vector<Constraint>& threads, double density,
                std::vector<double>& masses) {
  for (const Constraint& thread : threads) {
    for (const std::uint32_t end : {thread.a, thread.b})
      masses[end] += density * thread.rest_length / 2;
  }
}

}  // namespace weft::mesh
