/// Where a scene comes from: a built-in name, a .json scene file or an .obj mesh.
#pragma once

#include <weft/weft.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/program/options/material_options.h"
#include "tools/program/options/world_options.h"
#include "tools/program/terminal/command_line.h"
#include "tools/scenes/events.h"
#include "tools/scenes/mesh.h"
#include "tools/scenes/pin_moves.h"
#include "tools/scenes/rest_scale.h"
#include "tools/scenes/scene_body.h"

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
  std::optional<std::string> up;
  std::optional<double> weld;
  std::vector<std::string> seams;
  std::optional<double> seam_time, seam_force;
  std::optional<std::string> rest;
  std::optional<std::string> warp;
  std::optional<double> thread_density;
  std::optional<std::string> ropes;
  MaterialOptions material;
  WorldOptions world;
  bool diagonals = false;
};

void add_scene_options(Verb verb, SceneOptions& options);

struct SceneSource {
  std::string name;  ///< the built-in name, or the file's path
  /// For what is written: the built-in name, or the file's without its folders, which say
  /// something of this machine and nothing of the scene.
  std::string title() const;
  SceneDescription description;
  Mesh mesh;
  std::vector<PinMove> moves = {};
  std::vector<SceneBody> bodies = {};
  std::vector<SceneEvent> events = {};
  RestScale rest_scale = {};
  std::optional<MeshCounts> counts = {};  ///< of a mesh that was read
  std::vector<std::string> notes = {};    ///< for whoever runs it, a line each
  double Vec3::*up = &Vec3::y;            ///< what heights are measured along
};

Result<SceneSource> load_scene(const SceneOptions& options);
/// An error names the file. Without one the scene is looked over, for its notes and findings.
Result<std::shared_ptr<const Model>> model_of(SceneSource& source);

}  // namespace weft::tools
