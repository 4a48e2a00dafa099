/// Scenes with anchors.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/vectors.h"

namespace weft::test::anchored {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline Settings small_steps(Backend backend, int substeps = kAutomaticSubsteps) {
  return {.substeps = substeps, .solver = Solver::small_steps, .backend = backend, .threads = 1};
}

/// A particle of 1 kg with an anchor.
inline SceneDescription one_particle(Vec3 position, Vec3 velocity, const Anchor& anchor) {
  SceneDescription scene;
  scene.positions = {position};
  scene.velocities = {velocity};
  scene.masses = {1};
  scene.anchors = {anchor};
  return scene;
}

/// An anchor for every particle, where it is.
inline void anchor_all(SceneDescription& scene, double max_distance) {
  for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
    if (std::ranges::find(scene.fixed, i) != scene.fixed.end()) continue;
    scene.anchors.push_back(
        {.particle = i, .point = scene.positions[i], .max_distance = max_distance});
  }
}

/// m, the largest of a particle from its point.
inline double largest_reach(const SceneDescription& scene, const Cloth& cloth,
                            const std::vector<Vec3>& points) {
  double most = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    most = std::max(most, distance(cloth.position(scene.anchors[i].particle), points[i]));
  }
  return most;
}

inline std::vector<Vec3> points_of(const SceneDescription& scene) {
  std::vector<Vec3> points;
  for (const Anchor& anchor : scene.anchors) points.push_back(anchor.point);
  return points;
}

}  // namespace weft::test::anchored
