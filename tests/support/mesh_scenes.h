/// Scenes beyond the built-in ones: other meshes, ropes, hubs.
#pragma once

#include <weft/weft.h>

#include <string>
#include <vector>

#include "tests/support/meshes.h"

namespace weft::test {

/// A mesh at rest, of 1 kg, its longest side 1 m; the first particle and the one farthest from it
/// along the last axis are fixed.
SceneDescription scene_of(const Mesh& mesh);

/// A sheet whose diagonals are ropes, just taut.
SceneDescription roped_sheet(std::uint32_t size);
/// A sheet with one fixed side, and a rope along one diagonal of each cell.
SceneDescription braced_sheet(std::uint32_t size);
/// Triangles of any shape, some links missing: hardly a run in it.
SceneDescription random_sheet(std::uint32_t size, std::uint32_t seed);
/// A sheet whose middle holds ropes to all of its border: a hub.
SceneDescription hub_sheet(std::uint32_t size);

struct NamedScene {
  std::string name;
  SceneDescription scene;
};

/// A sheet of 40 x 40 and, in it and around it, 40 spheres of radii from 0.01 to 1 m, some fixed.
SceneDescription sheet_among_spheres(std::uint32_t seed);

}  // namespace weft::test
