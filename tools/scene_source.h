/// Where a scene comes from: a built-in name, a .json scene file or an .obj mesh.
#pragma once

#include <weft/weft.h>

#include <optional>
#include <string>
#include <vector>

#include "tools/command_line.h"
#include "tools/material_options.h"
#include "tools/mesh.h"
#include "tools/pin_moves.h"

namespace weft::tools {

/// As given on the command line. An option that has no meaning for the scene is refused.
struct SceneOptions {
  std::string scene;
  std::optional<int> size;
  std::optional<double> slack;
  std::optional<double> sphere_mass;
  std::optional<double> end_mass;
  std::optional<std::string> pin;
  std::optional<double> mass;
  std::optional<double> scale;
  std::optional<std::string> ropes;
  MaterialOptions material;
  bool diagonals = false;
};

void add_scene_options(Verb verb, SceneOptions& options);

struct SceneSource {
  std::string name;  ///< the built-in name, or the file's path
  SceneDescription description;
  Mesh mesh;
  std::vector<PinMove> moves = {};
  std::string note = {};  ///< one line for whoever runs it, or empty
};

Result<SceneSource> load_scene(const SceneOptions& options);

}  // namespace weft::tools
