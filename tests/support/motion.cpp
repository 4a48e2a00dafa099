#include "tests/support/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/vectors.h"

namespace weft::test {
namespace {

bool joined(const SceneDescription& scene, std::size_t i, std::size_t j) {
  return std::ranges::any_of(scene.constraints, [&](const Constraint& c) {
    return (c.a == i && c.b == j) || (c.a == j && c.b == i);
  });
}

}  // namespace

Vec3 momentum(const std::vector<double>& masses, const std::vector<Vec3>& velocities) {
  Vec3 sum;
  for (std::size_t i = 0; i < masses.size(); ++i) sum = sum + masses[i] * velocities[i];
  return sum;
}

Vec3 angular_momentum(const std::vector<double>& masses, const std::vector<Vec3>& positions,
                      const std::vector<Vec3>& velocities) {
  Vec3 sum;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    sum = sum + masses[i] * cross(positions[i], velocities[i]);
  }
  return sum;
}

std::vector<bool> are_fixed(const SceneDescription& scene) {
  std::vector<bool> fixed(scene.positions.size());
  for (const std::uint32_t i : scene.fixed) fixed[i] = true;
  return fixed;
}

std::vector<double> strains(const SceneDescription& scene, const std::vector<Vec3>& positions) {
  const std::vector<bool> fixed = are_fixed(scene);
  std::vector<double> strains;
  for (const Constraint& c : scene.constraints) {
    const double excess = distance(positions[c.a], positions[c.b]) - c.rest_length;
    const bool inert = fixed[c.a] && fixed[c.b];
    const double error = c.kind == ConstraintKind::rope ? std::max(excess, 0.0) : std::abs(excess);
    strains.push_back(inert ? 0.0 : error / c.rest_length);
  }
  return strains;
}

double max_strain(const SceneDescription& scene, const std::vector<Vec3>& positions) {
  double largest = 0;
  for (const double strain : strains(scene, positions)) largest = std::max(largest, strain);
  return largest;
}

double max_penetration(const SceneDescription& scene, const std::vector<Vec3>& positions) {
  const std::vector<bool> fixed = are_fixed(scene);
  double deepest = 0;
  for (const std::uint32_t s : scene.spheres) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (i == s || (fixed[s] && fixed[i])) continue;
      const double overlap = scene.radii[s] + scene.radii[i] - distance(positions[s], positions[i]);
      if (overlap > deepest && !joined(scene, s, i)) deepest = overlap;
    }
  }
  return deepest;
}

double energy(const SceneDescription& scene, const std::vector<Vec3>& positions,
              const std::vector<Vec3>& velocities) {
  const std::vector<bool> fixed = are_fixed(scene);
  double sum = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (fixed[i]) continue;
    sum += scene.masses[i] *
           (dot(velocities[i], velocities[i]) / 2 - dot(scene.gravity, positions[i]));
  }
  return sum;
}

double pendulum_period(double angle) {
  double a = 1, g = std::cos(angle / 2);
  for (int i = 0; i < 10; ++i) {
    const double mean = (a + g) / 2;
    g = std::sqrt(a * g);
    a = mean;
  }
  return 2 * std::numbers::pi * std::sqrt(0.1) / a;
}

}  // namespace weft::test
