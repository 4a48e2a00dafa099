#include "tools/program/measure/stretch.h"

#include <algorithm>
#include <cmath>

#include "engine/mesh/pair_numbers.h"
#include "tools/program/measure/fabric_laws.h"

namespace weft::tools {
namespace {

double strain_of(const Constraint& c, std::span<const Vec3> positions) {
  const Vec3 a = positions[c.a], b = positions[c.b];
  const double strain = std::hypot(b.x - a.x, b.y - a.y, b.z - a.z) / c.rest_length - 1;
  return c.kind == ConstraintKind::rope ? std::max(strain, 0.0) : strain;
}

double larger(double a, double b) { return std::abs(b) > std::abs(a) ? b : a; }

/// Of warp and weft, for the laws that it has.
double strain_of(const MembraneElement& element, std::span<const Vec3> positions) {
  const auto& [a, b, c] = element.particles;
  const FabricStrain strain = fabric_strain(element, positions[a], positions[b], positions[c]);
  const auto felt = [&](double along, double stiffness) {
    if (!(stiffness > 0)) return 0.0;
    return element.kind == ConstraintKind::rope ? std::max(along, 0.0) : along;
  };
  return larger(felt(strain.warp, element.warp), felt(strain.weft, element.weft));
}

}  // namespace

std::vector<bool> find_diagonals(std::span<const Constraint> constraints,
                                 std::span<const std::array<std::uint32_t, 4>> cells) {
  mesh::PairNumbers diagonals(2 * cells.size());
  for (const auto& [a, b, c, d] : cells) {
    diagonals.add(a, c);
    diagonals.add(b, d);
  }
  std::vector<bool> is_diagonal;
  for (const Constraint& c : constraints) is_diagonal.push_back(diagonals.contains(c.a, c.b));
  return is_diagonal;
}

StretchMeasure::StretchMeasure(const SceneDescription& scene,
                               std::span<const std::array<std::uint32_t, 4>> cells) {
  std::vector<bool> is_fixed(scene.positions.size());
  for (const std::uint32_t particle : scene.fixed) is_fixed[particle] = true;
  const std::vector<bool> is_diagonal = find_diagonals(scene.constraints, cells);
  for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
    const Constraint& c = scene.constraints[i];
    if (!is_diagonal[i] && !(is_fixed[c.a] && is_fixed[c.b])) constraints_.push_back(c);
  }
  for (const MembraneElement& element : scene.membrane) {
    const auto is_held = [&](std::uint32_t particle) { return is_fixed[particle]; };
    if (!std::ranges::all_of(element.particles, is_held)) elements_.push_back(element);
  }
}

std::vector<double> StretchMeasure::operator()(std::span<const Vec3> positions) const {
  std::vector<double> stretch(positions.size());
  const auto add = [&](std::uint32_t particle, double strain) {
    stretch[particle] = larger(stretch[particle], strain);
  };
  for (const Constraint& c : constraints_) {
    const double strain = strain_of(c, positions);
    add(c.a, strain);
    add(c.b, strain);
  }
  for (const MembraneElement& element : elements_) {
    const double strain = strain_of(element, positions);
    for (const std::uint32_t particle : element.particles) add(particle, strain);
  }
  return stretch;
}

}  // namespace weft::tools
