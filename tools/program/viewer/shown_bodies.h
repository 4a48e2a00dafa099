/// Bodies of a scene as a picture shows them: their shapes once, their poses in each sample.
/// Spheres of the scene are balls that move with their particle.
#pragma once

#include <weft/weft.h>

#include <array>
#include <span>
#include <string>
#include <vector>

#include "tools/program/files/json_output.h"
#include "tools/program/viewer/moving_points.h"
#include "tools/program/viewer/sections.h"
#include "tools/scenes/scene_body.h"

namespace weft::tools {

class ShownBodies {
 public:
  /// What is given must outlive this. quantum: of the vertices of bodies that deform, m.
  ShownBodies(const SceneDescription& scene, std::span<const SceneBody> bodies, double quantum);
  /// cloth: when a step has ended; null: at the start.
  void add_sample(std::span<const Vec3> particles, double time, const Cloth* cloth);
  /// Appends the sections. Returns one object for each body.
  Json write(Sections& sections) const;

 private:
  struct Moving {
    std::vector<float> poses;          ///< x y z of the position and x y z w of the rotation
    std::vector<MovingPoints> points;  ///< one where the body deforms
  };
  Json shape_of(std::size_t body, const std::string& name, Sections& sections) const;

  const SceneDescription& scene_;
  std::span<const SceneBody> bodies_;
  std::vector<Moving> moving_;  ///< of the bodies, then of the spheres
};

}  // namespace weft::tools
