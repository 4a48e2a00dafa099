/// A built-in scene, and what may be asked of it.
#pragma once

#include <weft/mesh.h>

#include <optional>
#include <vector>

#include "tools/scenes/mesh.h"
#include "tools/scenes/scene_body.h"

namespace weft::scenes {

struct Options {
  int size = 20;           ///< N; particles in a line for "chain"
  double slack = 0.05;     ///< sphere_drop: how much longer the sheet is than the gap it spans
  double sphere_mass = 1;  ///< sphere_drop, kg
  double end_mass = 1;     ///< chain, kg of the last particle
  bool diagonals = false;  ///< both diagonals of every four-sided face are ropes; not for "chain"
  bool ropes = false;      ///< every edge is a rope; not for "chain"
  std::optional<Material> material = std::nullopt;
};

/// What fabric is made of if nothing else is asked for.
inline constexpr const char* kFabric = "cotton";

struct Scene {
  SceneDescription description;
  tools::Mesh mesh;  ///< what pictures show: vertices and faces, or the lines of a chain
  std::vector<tools::SceneBody> bodies = {};
  std::vector<tools::PinMove> moves = {};
};

}  // namespace weft::scenes
