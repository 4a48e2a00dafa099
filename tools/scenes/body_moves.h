/// How the bodies of a scene move in a run. A body has its place among them as its id in the cloth.
#pragma once

#include <weft/weft.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/scenes/scene_body.h"

namespace weft::tools {

Pose pose_at(const SceneBody& body, double time);
/// When a step has ended at `time`. One with a mass is where the cloth says.
Pose pose_in(const Cloth& cloth, std::uint32_t id, const SceneBody& body, double time);
/// The body has a mass.
Vec3 centre_of_mass(const SceneBody& body, const Pose& pose);
/// Of a mesh, in coordinates of the body.
std::vector<Vec3> vertices_at(const SceneBody& body, double time);
/// Of a mesh, in coordinates of the scene.
std::vector<Vec3> places_at(const SceneBody& body, double time);

/// How many triangles those have that are meshes.
std::size_t count_triangles(std::span<const SceneBody> bodies);

/// The bodies of a scene that goes on from where this one is after `elapsed` seconds.
std::vector<SceneBody> present_bodies(std::span<const SceneBody> bodies, double elapsed);
/// Puts those with a mass where they have come to in the cloth, with their velocities.
void take_free_bodies(const Cloth& cloth, std::vector<SceneBody>& bodies);

/// A call of Cloth::move_body.
struct PosedBody {
  std::uint32_t id = 0;
  Pose pose{};
};
/// A call of Cloth::move_body_vertices.
struct DeformedBody {
  std::uint32_t id = 0;
  std::vector<Vec3> vertices = {};
};

/// Bodies of one cloth.
class MovedBodies {
 public:
  /// Adds them where they are at time 0.
  static Result<MovedBodies> add(std::span<const SceneBody> bodies, Cloth& cloth);
  /// Sends those that move to where they are at `time`.
  Result<void> send(Cloth& cloth, double time) const;
  std::vector<PosedBody> poses_at(double time) const;
  std::vector<DeformedBody> deformed_at(double time) const;

 private:
  std::span<const SceneBody> bodies_;
  std::vector<std::uint32_t> ids_;
};

}  // namespace weft::tools
