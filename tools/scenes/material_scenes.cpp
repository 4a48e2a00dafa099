#include "tools/scenes/material_scenes.h"

#include <cstdint>
#include <utility>

namespace weft::scenes {
namespace {

/// N x N vertices, (i, j) numbered i N + j, and the cells between them.
template <class Place>
MeshDescription grid_of(int size, const Material& material, Place place) {
  MeshDescription mesh;
  const auto n = static_cast<std::uint32_t>(size);
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) {
      mesh.positions.push_back(
          place(static_cast<double>(i) / (size - 1), static_cast<double>(j) / (size - 1)));
    }
  }
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    for (std::uint32_t j = 0; j + 1 < n; ++j) {
      const std::uint32_t a = i * n + j;
      mesh.corners.insert(mesh.corners.end(), {a, a + 1, a + n + 1, a + n});
      mesh.face_sizes.push_back(4);
    }
  }
  mesh.material = material;
  return mesh;
}

}  // namespace

Result<SceneDescription> flag_of(int size, const Material& material) {
  MeshDescription mesh = grid_of(size, material, [](double s, double t) { return Vec3{s, -t, 0}; });
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(size); ++j) mesh.pins.push_back(j);
  auto cloth = cloth_from_mesh(mesh);
  if (!cloth) return Error{cloth.error()};
  cloth.value().scene.air.wind = {8, 0, 2};
  return std::move(cloth.value().scene);
}

Result<SceneDescription> drape_of(int size, const Material& material) {
  constexpr double kRadius = 0.3, kClearance = 0.01;
  auto cloth = cloth_from_mesh(grid_of(size, material, [](double s, double t) {
    return Vec3{s, 0, t};
  }));
  if (!cloth) return Error{cloth.error()};
  SceneDescription& scene = cloth.value().scene;
  const auto sphere = static_cast<std::uint32_t>(scene.positions.size());
  scene.radii.assign(scene.positions.size(), 0.0);
  scene.positions.push_back({0.5, -kRadius - kClearance, 0.5});
  scene.masses.push_back(1);
  scene.radii.push_back(kRadius);
  scene.spheres = {sphere};
  scene.fixed.push_back(sphere);
  return std::move(scene);
}

}  // namespace weft::scenes
