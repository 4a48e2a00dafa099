/// Bodies of a scene: the key "bodies" of a scene file (scene_file.h), and how they move in a run.
#pragma once

#include <weft/weft.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tools/crossings.h"
#include "tools/json_output.h"
#include "tools/scene_body.h"

namespace weft::tools {

Pose pose_at(const SceneBody& body, double time);
/// Of a mesh.
std::vector<Vec3> vertices_at(const SceneBody& body, double time);

/// Throws Refused (json_reading.h). Files that bodies name are looked for from `folder`.
std::vector<SceneBody> read_bodies(const Json& json, const std::string& folder);
/// One entry of the array.
std::string body_row(const SceneBody& body);

/// The bodies of a scene that goes on from where this one is after `elapsed` seconds.
std::vector<SceneBody> present_bodies(std::span<const SceneBody> bodies, double elapsed);

/// All that are meshes, as one, where they are at a time.
TriangleSet meshes_at(std::span<const SceneBody> bodies, double time);
/// How many triangles those have that are meshes.
std::size_t count_triangles(std::span<const SceneBody> bodies);

/// Bodies of one cloth.
class MovedBodies {
 public:
  /// Adds them where they are at time 0.
  static Result<MovedBodies> add(std::span<const SceneBody> bodies, Cloth& cloth);
  /// Sends those that move to where they are at `time`.
  Result<void> send(Cloth& cloth, double time) const;

 private:
  std::span<const SceneBody> bodies_;
  std::vector<std::uint32_t> ids_;
};

}  // namespace weft::tools
