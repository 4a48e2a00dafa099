/// Scenes that are changed, and the settings that solve them.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "engine/erase_repeated.h"
#include "tests/support/clothes.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/vectors.h"
#include "tools/scenes/irregular_mesh.h"

namespace weft::test::changed {

/// Every solver on every backend that it has.
inline std::vector<Settings> all_solvers() {
  return {{.solver = Solver::small_steps},
          {.solver = Solver::small_steps, .scheme = Scheme::implicit},
          {.solver = Solver::small_steps, .backend = Backend::reference},
          {.solver = Solver::yarn},
          {.solver = Solver::direct},
          {.solver = Solver::direct, .scheme = Scheme::rattle},
          {.substeps = 1, .solver = Solver::gauss_seidel},
          {.substeps = 1, .solver = Solver::gauss_seidel, .backend = Backend::reference}};
}
inline std::vector<Settings> small_steps() {
  return {{.solver = Solver::small_steps},
          {.solver = Solver::small_steps, .backend = Backend::reference}};
}

inline std::string text(const Settings& settings) {
  return std::string(name(settings.solver)) + " " + std::string(name(settings.scheme)) + " " +
         std::string(name(settings.backend));
}

/// With constraints between neighbours in the list of pins.
inline SceneDescription with_inert(SceneDescription scene) {
  for (std::uint32_t j = 0; j + 1 < scene.fixed.size(); ++j) {
    const std::uint32_t a = scene.fixed[j], b = scene.fixed[j + 1];
    scene.constraints.push_back({a, b, distance(scene.positions[a], scene.positions[b])});
  }
  return scene;
}

/// The mesh of `cape` in cotton.
inline SceneDescription cotton_cape(int size) {
  const scenes::IrregularMesh mesh = scenes::irregular_mesh(size);
  MeshDescription description;
  description.positions = mesh.points;
  for (const scenes::Face& face : mesh.faces) {
    description.corners.insert(description.corners.end(), face.begin(), face.end());
    description.face_sizes.push_back(static_cast<std::uint32_t>(face.size()));
  }
  for (const std::uint32_t corner : description.corners) {
    if (mesh.points[corner].x < 1.19 / (size - 1)) description.pins.push_back(corner);
  }
  std::ranges::sort(description.pins);
  erase_repeated(description.pins);
  description.material = find_material("cotton").value();
  const auto made = cloth_from_mesh(description);
  REQUIRE_MESSAGE(made, made.error());
  return made.value().scene;
}

}  // namespace weft::test::changed
