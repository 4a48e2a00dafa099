#include "tools/program/measure/fabric_measure.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/geometry.h"
#include "engine/mesh/pair_numbers.h"

namespace weft::tools {
namespace {

using mesh::dot, mesh::length, mesh::unit, mesh::operator-;

constexpr std::size_t next(std::size_t corner) { return (corner + 1) % 4; }

double angle(double cosine) { return std::asin(std::clamp(cosine, -1.0, 1.0)); }

double size_of(double strain, bool is_rope) {
  return is_rope ? std::max(strain, 0.0) : std::abs(strain);
}

/// Constraints by the particles that they join.
class Joined {
 public:
  explicit Joined(const std::vector<Constraint>& constraints) : numbers_(constraints.size()) {
    for (const Constraint& c : constraints) {
      if (numbers_.add(c.a, c.b).second) first_.push_back(c);
    }
  }
  /// Null: none.
  const Constraint* find(std::uint32_t a, std::uint32_t b) {
    if (!numbers_.contains(a, b)) return nullptr;
    return &first_[numbers_.add(a, b).first];
  }

 private:
  mesh::PairNumbers numbers_;
  std::vector<Constraint> first_;
};

/// Sides 0 and 2 run along the warp, to opposite ends.
double angle_between(const std::array<Vec3, 4>& sides) {
  return angle(dot(unit(sides[0] - sides[2]), unit(sides[1] - sides[3])));
}

/// In a parallelogram the squares of the diagonals differ by four times the product of the sides.
double rest_angle(const Constraint* one, const Constraint* other, double warp, double weft) {
  if (one == nullptr || other == nullptr || !(warp * weft > 0)) return 0;
  const double difference =
      one->rest_length * one->rest_length - other->rest_length * other->rest_length;
  return angle(difference / (4 * warp * weft));
}

}  // namespace

FabricStrain largest(const FabricStrain& a, const FabricStrain& b) {
  return {std::max(a.warp, b.warp), std::max(a.weft, b.weft), std::max(a.shear, b.shear)};
}

FabricMeasure::FabricMeasure(const SceneDescription& scene,
                             const std::vector<std::array<std::uint32_t, 4>>& cells) {
  std::vector<bool> is_fixed(scene.positions.size(), false);
  for (const std::uint32_t particle : scene.fixed) is_fixed[particle] = true;
  const auto all_fixed = [&](std::span<const std::uint32_t> particles) {
    return std::ranges::all_of(particles, [&](std::uint32_t p) { return is_fixed[p]; });
  };
  Joined joined(scene.constraints);
  for (const auto& particles : cells) {
    if (all_fixed(particles)) continue;
    Cell cell{particles};
    for (std::size_t side = 0; side < 4; ++side) {
      const std::array ends{particles[side], particles[next(side)]};
      const Constraint* spring = joined.find(ends[0], ends[1]);
      if (spring == nullptr || all_fixed(ends)) continue;
      cell.sides[side] = {spring->rest_length, spring->kind == ConstraintKind::rope};
    }
    const auto mean = [&](std::size_t side) {
      return (cell.sides[side].length + cell.sides[side + 2].length) / 2;
    };
    cell.rest_angle = rest_angle(joined.find(particles[0], particles[2]),
                                 joined.find(particles[1], particles[3]), mean(0), mean(1));
    cells_.push_back(cell);
  }
  for (const MembraneElement& element : scene.membrane) {
    if (!all_fixed(element.particles)) elements_.push_back(element);
  }
}

FabricStrain FabricMeasure::strain_of(const Cell& cell, const Cloth& cloth) const {
  FabricStrain strain;
  std::array<Vec3, 4> sides;
  for (std::size_t i = 0; i < 4; ++i) {
    sides[i] = cloth.position(cell.particles[next(i)]) - cloth.position(cell.particles[i]);
    const auto [rest, is_rope] = cell.sides[i];
    if (!(rest > 0)) continue;
    double& most = i % 2 == 0 ? strain.warp : strain.weft;
    most = std::max(most, size_of(length(sides[i]) / rest - 1, is_rope));
  }
  strain.shear = std::abs(angle_between(sides) - cell.rest_angle);
  return strain;
}

FabricStrain FabricMeasure::strain_of(const MembraneElement& element, const Cloth& cloth) const {
  const auto& [a, b, c] = element.particles;
  const FabricStrain laws =
      fabric_strain(element, cloth.position(a), cloth.position(b), cloth.position(c));
  const bool is_rope = element.kind == ConstraintKind::rope;
  return {element.warp > 0 ? size_of(laws.warp, is_rope) : 0,
          element.weft > 0 ? size_of(laws.weft, is_rope) : 0, std::abs(angle(laws.shear))};
}

FabricStrain FabricMeasure::operator()(const Cloth& cloth) const {
  FabricStrain strain;
  for (const Cell& cell : cells_) strain = largest(strain, strain_of(cell, cloth));
  for (const MembraneElement& element : elements_)
    strain = largest(strain, strain_of(element, cloth));
  return strain;
}

}  // namespace weft::tools
