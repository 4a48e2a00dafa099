/// What a motion keeps and what it violates, recomputed from positions and velocities.
#pragma once

#include <weft/weft.h>

#include <vector>

namespace weft::test {

Vec3 momentum(const std::vector<double>& masses, const std::vector<Vec3>& velocities);
Vec3 angular_momentum(const std::vector<double>& masses, const std::vector<Vec3>& positions,
                      const std::vector<Vec3>& velocities);

/// Per particle.
std::vector<bool> are_fixed(const SceneDescription& scene);

/// | |a-b| - rest | / rest of a bar, the excess over 0 of a rope, 0 where both ends are fixed.
std::vector<double> strains(const SceneDescription& scene, const std::vector<Vec3>& positions);
double max_strain(const SceneDescription& scene, const std::vector<Vec3>& positions);
/// Over all pairs of a sphere with another particle that are not both fixed, nor joined.
double max_penetration(const SceneDescription& scene, const std::vector<Vec3>& positions);
/// Kinetic and gravitational energy of what is not fixed.
double energy(const SceneDescription& scene, const std::vector<Vec3>& positions,
              const std::vector<Vec3>& velocities);

/// s, of a pendulum of 1 m that is let go at `angle` rad, at 10 m/s^2: by the arithmetic-geometric
/// mean (Gauss).
double pendulum_period(double angle);

}  // namespace weft::test
