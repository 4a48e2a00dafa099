/// Points that follow the triangles of a cloth, by their place in a triangle and their distance to
/// it.
#pragma once

#include <weft/scene.h>

#include <span>
#include <vector>

#include "engine/surface/nearest_triangle.h"
#include "engine/surface/normals.h"

namespace weft::surface {

/// x = x_0 + b (x_1 - x_0) + c (x_2 - x_0) + height n,
///     n = n_0 + normal_b (n_1 - n_0) + normal_c (n_2 - n_0), made a unit,
/// with positions x_i and normals n_i of the corners. Where normal_b is kOwn, n is the triangle's.
struct Following {
  static constexpr float kOwn = -1;
  Triangle corners{};
  float b = 0, c = 0;
  float normal_b = 0, normal_c = 0;
  float height = 0;  ///< m
};

/// positions and normals: of the corners. nearest: where the place is.
Following following(Vec3 place, const Triangle& triangle, const Nearest& nearest,
                    std::span<const Vec3> positions, std::span<const Quad> normals);

/// Where they are.
void place_points(std::span<const Following> points, std::span<const Vec3> positions,
                  std::span<const Quad> normals, std::span<Vec3> out);
/// How fast they are, with the normal turning as the triangle does.
void find_velocities(std::span<const Following> points, std::span<const Vec3> positions,
                     std::span<const Vec3> velocities, std::span<const Quad> normals,
                     std::span<Vec3> out);

}  // namespace weft::surface
