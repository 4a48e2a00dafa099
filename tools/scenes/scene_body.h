/// A body of a scene.
#pragma once

#include <weft/weft.h>

#include <optional>
#include <vector>

#include "tools/scenes/pin_moves.h"

namespace weft::tools {

/// How the vertices of a mesh move, in coordinates of the body: linear between the times, still
/// before the first and after the last.
struct VertexMove {
  std::vector<double> times = {};                ///< s; one at least, increasing
  std::vector<std::vector<Vec3>> vertices = {};  ///< one list per time, of all vertices
};

/// It begins at a pose and moves as pins do: x goes to where place_at() takes it. One with a mass
/// moves by itself instead.
struct SceneBody {
  ShapeDescription shape;
  Vec3 position{};
  Vec3 rotation{};                      ///< rad, a rotation vector
  double thickness = Body{}.thickness;  ///< m
  double friction = Body{}.friction;
  std::optional<PinMove> move = {};            ///< of no particles
  std::optional<VertexMove> vertex_move = {};  ///< of a TriangleMesh alone
  std::optional<BodyMass> mass = {};           ///< of a body that has no move
  BodyVelocity velocity = {};                  ///< with a mass: at the start
};

}  // namespace weft::tools
