#include "tools/studies/hard/oracle.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "tools/program/measure/fabric_laws.h"

namespace weft::tools::hard {
namespace {

bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

std::vector<bool> fixed_particles(const SceneDescription& scene) {
  std::vector<bool> fixed(scene.positions.size());
  for (const std::uint32_t particle : scene.fixed) fixed[particle] = true;
  return fixed;
}

Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec3 operator*(double s, Vec3 v) { return {s * v.x, s * v.y, s * v.z}; }
Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(Vec3 v) { return std::sqrt(dot(v, v)); }

Snapshot snapshot(const Cloth& cloth) {
  Snapshot state;
  for (std::uint32_t i = 0; i < cloth.particle_count(); ++i) {
    state.positions.push_back(cloth.position(i));
    state.velocities.push_back(cloth.velocity(i));
  }
  return state;
}

bool all_finite(const Snapshot& state) {
  return std::ranges::all_of(state.positions, finite) &&
         std::ranges::all_of(state.velocities, finite);
}

namespace {

double strain_over(const SceneDescription& scene, const Snapshot& state, bool springs_too) {
  const std::vector<bool> fixed = fixed_particles(scene);
  double most = 0;
  for (const Constraint& c : scene.constraints) {
    if (fixed[c.a] && fixed[c.b]) continue;
    if (c.compliance > 0 && !springs_too) continue;
    const double stretch =
        (length(state.positions[c.a] - state.positions[c.b]) - c.rest_length) / c.rest_length;
    most = std::max(most, c.kind == ConstraintKind::rope ? stretch : std::abs(stretch));
  }
  return most;
}

double strain_of_triangles(const SceneDescription& scene, const Snapshot& state) {
  const std::vector<bool> fixed = fixed_particles(scene);
  double most = 0;
  for (const MembraneElement& m : scene.membrane) {
    const auto& [a, b, c] = m.particles;
    if (fixed[a] && fixed[b] && fixed[c]) continue;
    const auto& x = state.positions;
    const FabricStrain strain = fabric_strain(m, x[a], x[b], x[c]);
    for (const double stretch : {strain.warp, strain.weft})
      most = std::max(most, m.kind == ConstraintKind::rope ? stretch : std::abs(stretch));
  }
  return most;
}

}  // namespace

double max_rigid_strain(const SceneDescription& scene, const Snapshot& state) {
  return strain_over(scene, state, false);
}
double max_strain(const SceneDescription& scene, const Snapshot& state) {
  return std::max(strain_over(scene, state, true), strain_of_triangles(scene, state));
}

double max_penetration(const SceneDescription& scene, const Snapshot& state) {
  if (scene.spheres.empty()) return 0;
  const std::vector<bool> fixed = fixed_particles(scene);
  std::set<std::pair<std::uint32_t, std::uint32_t>> joined;
  for (const Constraint& c : scene.constraints) joined.insert(std::minmax(c.a, c.b));
  double deepest = 0;
  for (const std::uint32_t s : scene.spheres) {
    for (std::uint32_t p = 0; p < state.positions.size(); ++p) {
      if (p == s || (fixed[s] && fixed[p]) || joined.contains(std::minmax(s, p))) continue;
      const double apart = length(state.positions[s] - state.positions[p]);
      deepest = std::max(deepest, scene.radii[s] + scene.radii[p] - apart);
    }
  }
  return deepest;
}

bool went_through(const SceneDescription& scene, const Snapshot& before, const Snapshot& after,
                  std::uint32_t sphere) {
  constexpr int kPlaces = 1000;  // on the way, which is straight
  for (std::uint32_t p = 0; p < before.positions.size(); ++p) {
    if (p == sphere) continue;
    const double inner = 0.9 * (scene.radii[sphere] + scene.radii[p]);
    const Vec3 from = before.positions[p] - before.positions[sphere];
    const Vec3 to = after.positions[p] - after.positions[sphere];
    if (length(from) < scene.radii[sphere] || length(to) < scene.radii[sphere] * 0.999) continue;
    for (int k = 0; k <= kPlaces; ++k) {
      if (length(from + (k / static_cast<double>(kPlaces)) * (to - from)) < inner) return true;
    }
  }
  return false;
}

double kinetic_energy(const SceneDescription& scene, const Snapshot& state) {
  const std::vector<bool> fixed = fixed_particles(scene);
  double sum = 0;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    if (!fixed[i]) sum += scene.masses[i] * dot(state.velocities[i], state.velocities[i]) / 2;
  }
  return sum;
}

double energy(const SceneDescription& scene, const Snapshot& state) {
  const std::vector<bool> fixed = fixed_particles(scene);
  double sum = kinetic_energy(scene, state);
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    if (!fixed[i]) sum -= scene.masses[i] * dot(scene.gravity, state.positions[i]);
  }
  return sum;
}

Vec3 momentum(const SceneDescription& scene, const Snapshot& state) {
  Vec3 sum;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    sum = sum + scene.masses[i] * state.velocities[i];
  }
  return sum;
}

Vec3 angular_momentum(const SceneDescription& scene, const Snapshot& state, Vec3 centre) {
  Vec3 sum;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    sum = sum + scene.masses[i] * cross(state.positions[i] - centre, state.velocities[i]);
  }
  return sum;
}

}  // namespace weft::tools::hard
