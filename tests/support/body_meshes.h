/// Bodies of triangles, and where they are.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace weft::test {

/// A sphere of 20 * 4^level triangles whose corners are on it.
TriangleMesh icosphere(double radius, int level);
/// A box around the origin, each of whose sides has cuts^2 squares of two triangles.
TriangleMesh box_mesh(Vec3 size, std::uint32_t cuts);
/// A square in the plane y = 0 with its normal along y, of cuts^2 squares of two triangles.
TriangleMesh plane_mesh(double size, std::uint32_t cuts);
/// A wedge, its edge along z at the origin, down from there; `angle` rad between its sides.
TriangleMesh knife_mesh(double angle, double depth, double length, std::uint32_t cuts);

/// m, of the flattest place of an icosphere: its faces are this near to the centre.
double inner_radius(const TriangleMesh& mesh);

std::shared_ptr<const BodyShape> shape_of(const ShapeDescription& shape);
std::uint32_t add(Cloth& cloth, const Body& body);

Vec3 turned(const Rotation& by, Vec3 v);
/// By an angle (rad) about an axis of length 1.
Rotation turn(Vec3 axis, double angle);
std::vector<Vec3> placed(const std::vector<Vec3>& vertices, const Pose& pose);

}  // namespace weft::test
