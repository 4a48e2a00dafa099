#include "perf/meshes.h"

#include <cmath>
#include <utility>

#include "tools/scenes/irregular_mesh.h"

namespace weft::perf {
namespace {

double distance(Vec3 a, Vec3 b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

}  // namespace

SceneDescription grid(int size) {
  const auto n = static_cast<std::uint32_t>(size);
  const double spacing = 1.0 / (n - 1);
  SceneDescription scene;
  Random random(1);
  const auto jitter = [&] { return 0.02 * spacing * (2 * random.unit() - 1); };
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      scene.positions.push_back({i * spacing + jitter(), jitter(), j * spacing + jitter()});
      const std::uint32_t p = i * n + j;
      if (i + 1 < n) scene.constraints.push_back({p, p + n, spacing});
      if (j + 1 < n) scene.constraints.push_back({p, p + 1, spacing});
    }
  }
  scene.masses.assign(scene.positions.size(), 1.0 / (n * n));
  return scene;
}

SceneDescription irregular(int size) {
  scenes::IrregularMesh mesh = scenes::irregular_mesh(size);
  SceneDescription scene;
  scene.positions = std::move(mesh.points);
  scene.fixed = std::move(mesh.first_row);
  for (const auto& [a, b] : scenes::edges_of(mesh.faces)) {
    scene.constraints.push_back({a, b, distance(scene.positions[a], scene.positions[b])});
  }
  const auto n = static_cast<std::uint32_t>(size);
  scene.masses.assign(scene.positions.size(), 1.0 / (n * n));
  return scene;
}

}  // namespace weft::perf
