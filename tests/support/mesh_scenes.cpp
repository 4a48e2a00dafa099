#include "tests/support/mesh_scenes.h"

#include <cmath>

#include <algorithm>
#include <numeric>

#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test {

SceneDescription scene_of(const Mesh& mesh) {
  SceneDescription scene;
  double side = 0;
  std::uint32_t far = 0;
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
    side = std::max({side, mesh.positions[i].x, mesh.positions[i].z});
    if (mesh.positions[i].z > mesh.positions[far].z) far = i;
  }
  for (const Vec3& p : mesh.positions) {
    scene.positions.push_back((1 / side) * p);
    scene.masses.push_back(1.0 / static_cast<double>(mesh.positions.size()));
  }
  for (const Link& link : mesh.links) {
    const double rest = distance(scene.positions[link.a], scene.positions[link.b]);
    scene.constraints.push_back({link.a, link.b, rest, link.kind});
  }
  scene.fixed = {0, far};
  return scene;
}

SceneDescription roped_sheet(std::uint32_t size) {
  Mesh mesh = grid(size, size);
  add_diagonals(mesh, size, size, ConstraintKind::rope);
  return scene_of(mesh);
}

SceneDescription braced_sheet(std::uint32_t size) {
  Mesh mesh = grid(size, size);
  for (std::uint32_t k = 0; k + size < size * size; ++k) {
    if ((k + 1) % size > 0) mesh.links.push_back({k, k + size + 1, ConstraintKind::rope});
  }
  SceneDescription scene = scene_of(mesh);
  scene.fixed.resize(size);
  std::iota(scene.fixed.begin(), scene.fixed.end(), 0u);
  return scene;
}

SceneDescription random_sheet(std::uint32_t size, std::uint32_t seed) {
  Random random(seed);
  return scene_of(shuffled(triangles(size, size, 0.3, 0.05, random), random));
}

SceneDescription hub_sheet(std::uint32_t size) {
  Mesh mesh = grid(size, size);
  const std::uint32_t middle = size / 2 * size + size / 2;
  for (std::uint32_t k = 0; k + 1 < size; ++k) {
    for (const std::uint32_t border :
         {k, (k + 1) * size - 1, size * size - 1 - k, (k + 1) * size}) {
      mesh.links.push_back({middle, border, ConstraintKind::rope});
    }
  }
  return scene_of(mesh);
}

SceneDescription sheet_among_spheres(std::uint32_t seed) {
  SceneDescription scene = drifting_sheet(40, seed);
  Random random(seed + 1);
  scene.radii.clear();
  Vec3 middle;
  for (const Vec3& at : scene.positions) {
    middle = middle + (1.0 / 1600) * at;
    scene.radii.push_back(random.below(3) == 0 ? random.between(0, 0.05) : 0);
  }
  for (int i = 0; i < 40; ++i) {
    scene.spheres.push_back(static_cast<std::uint32_t>(scene.positions.size()));
    if (random.below(2) == 0) scene.fixed.push_back(scene.spheres.back());
    scene.positions.push_back(middle + random.in_box(random.below(4) == 0 ? 30 : 2.5));
    scene.velocities.push_back(random.in_box(1));
    scene.masses.push_back(1);
    scene.radii.push_back(std::pow(10, random.between(-2, 0)));
  }
  return scene;
}

}  // namespace weft::test
