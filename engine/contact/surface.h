/// A surface of triangles that may touch another one: the cloth's, or that of a body.
#pragma once

#include <weft/scene.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/bodies/body_shape.h"
#include "engine/contact/seen_from_body.h"
#include "engine/contact/side_normals.h"
#include "engine/contact/tube.h"
#include "engine/sparse_array.h"
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
  bool is_open = true;  // it has a border: what is not inside may be on either side
  BoxTree own_tree;     // of its triangles, around tubes: of what is not rigid
  // Of a body:
  std::shared_ptr<const BodyShape> shape;  // keeps its mesh
  const MeshShape* mesh = nullptr;
  SideNormals normals;
  bool is_rigid = false;                          // its vertices are those of its shape
  bool stands = false;                            // besides, it does not move in this step
  std::span<const kernels::Vector> from{}, to{};  // vertices in its coordinates, in this step
  double longest = 0;                             // m, of their ways in a step
  Box extent = Box::none();                       // of them in its coordinates, all of the step
  SeenFromBody seen;                              // from when tubes were laid until the step ends
  std::uint32_t placing = 0;            // another one where its vertices are to be placed anew
  reference::Placement begins, ends;    // in the present interval
  SparseArray<std::uint32_t> active;    // per triangle: the laying of tubes since which it is
  std::vector<std::uint8_t> may_cross;  // per triangle of the cloth: tubes of both meet

  /// m, of what is solid around its triangles at most: a part of the thickness.
  double largest_radius() const { return mesh == nullptr ? 0 : mesh->radius; }
  /// The same where points of a pair count by these weights.
  double radius_at(const std::array<std::uint32_t, 4>& points,
                   const std::array<double, 4>& weights) const {
    if (mesh == nullptr || mesh->radii.empty()) return 0;
    double radius = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t vertex = points[k] - first_point;
      if (points[k] >= first_point && vertex < mesh->radii.size())
        radius += std::abs(weights[k]) * mesh->radii[vertex];
    }
    return radius;
  }
  /// The tree of a rigid body is around triangles, in coordinates of the body.
  const BoxTree& tree() const { return is_rigid ? mesh->tree : own_tree; }
  /// A box of the world as the tree has it.
  Box as_in_tree(const Box& box) const { return is_rigid ? seen(box) : box; }
  Box as_in_tree(const Tube& tube) const { return is_rigid ? seen(tube) : tube.all(); }
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
