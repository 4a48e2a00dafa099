/// A surface of triangles that may touch another one: the cloth's, or that of a body.
#pragma once

#include <weft/scene.h>

#include <cstdint>
#include <memory>

#include "engine/bodies/body_shape.h"
#include "engine/contact/side_normals.h"
#include "engine/triangles/box_tree.h"
#include "engine/triangles/triangle_surface.h"

namespace weft {

struct ContactSurface {
  const TriangleSurface* triangles = nullptr;
  std::uint32_t first_point = 0;  // its number among all points
  std::uint32_t body = kNoIndex;  // its owner, among those of the clock; none: the cloth
  double thickness = 0;           // m, that it keeps from surfaces before it
  double friction = 0;            // beside surfaces before it
  bool two_sided = true;
  BoxTree tree;                            // of its triangles, around wide boxes
  SideNormals normals;                     // of a body's
  bool has_moved = false;                  // a body's, since the last interval began
  std::shared_ptr<const BodyShape> shape;  // a body's: keeps its triangles

  TriangleSurface::Triangle points_of(std::uint32_t triangle) const {
    const auto [a, b, c] = triangles->triangles[triangle];
    return {first_point + a, first_point + b, first_point + c};
  }
};

/// The cloth is the first of all surfaces; bodies follow.
inline constexpr std::uint16_t kClothSurface = 0;

/// Two surfaces that may touch, the earlier one first.
struct SurfacePair {
  std::uint16_t a = 0, b = 0;
};

}  // namespace weft
