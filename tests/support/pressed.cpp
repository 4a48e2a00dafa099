#include "tests/support/pressed.h"

#include <weft/mesh.h>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/vectors.h"

namespace weft::test {

Triangles triangles_of(const TriangleMesh& mesh) {
  return {mesh.triangles.begin(), mesh.triangles.end()};
}

SceneDescription loose(const std::vector<Vec3>& positions, const Triangles& triangles,
                       double area_density) {
  SceneDescription scene;
  scene.positions = positions;
  scene.surface = triangles;
  scene.masses.assign(positions.size(), 0);
  for (const auto& [a, b, c] : triangles) {
    const double area =
        0.5 * length(cross(positions[b] - positions[a], positions[c] - positions[a]));
    for (const std::uint32_t corner : {a, b, c}) scene.masses[corner] += area_density * area / 3;
  }
  scene.gravity = {};
  return scene;
}

SceneDescription plate(double area_density) {
  const TriangleMesh mesh = plane_mesh(1, 4);
  return loose(mesh.vertices, triangles_of(mesh), area_density);
}

SceneDescription in_air(SceneDescription scene, Vec3 velocity) {
  scene.air.triangles = scene.surface;
  scene.air.density = kAirDensity;
  scene.air.ram = kRam;
  scene.velocities.assign(scene.positions.size(), velocity);
  return scene;
}

SceneDescription flap() {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}};
  scene.masses = {1, 1, 1};
  scene.fixed = {0, 1};
  scene.constraints = {{0, 2, std::hypot(1, 0.5)}, {1, 2, std::hypot(1, 0.5)}};
  scene.surface = {{0, 1, 2}};
  scene.gravity = {};
  return scene;
}

SceneDescription balloon(int level, double stiffness, double damping) {
  const TriangleMesh ball = icosphere(kBalloonRadius, level);
  MeshDescription mesh;
  mesh.positions = ball.vertices;
  for (const auto& t : ball.triangles) mesh.corners.insert(mesh.corners.end(), t.begin(), t.end());
  mesh.material = Material{.density = 0.2,
                           .warp = stiffness,
                           .weft = stiffness,
                           .shear = stiffness / 2,
                           .damping_motion = damping};
  SceneDescription scene = cloth_from_mesh(mesh).value().scene;
  scene.gravity = {};
  return scene;
}

}  // namespace weft::test
