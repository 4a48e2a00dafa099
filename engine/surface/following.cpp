#include "engine/surface/following.h"

#include "engine/geometry.h"

namespace weft::surface {
namespace {

using mesh::operator+;
using mesh::operator-;
using mesh::operator*;
using mesh::cross;
using mesh::dot;
using mesh::length;
using mesh::unit;

/// cos 60 degrees: flatter than that to its triangle a normal is not taken.
constexpr double kLeastUpright = 0.5;

/// Two edges from the first corner.
struct Edges {
  Vec3 to_b, to_c;
};
Edges edges_of(const Triangle& corners, std::span<const Vec3> of) {
  const Vec3 a = of[corners[0]];
  return {of[corners[1]] - a, of[corners[2]] - a};
}

/// A normal of unit length. edges: of the triangle.
Vec3 normal_of(const Following& point, const Edges& edges, std::span<const Quad> normals) {
  if (point.normal_b == Following::kOwn) return unit(cross(edges.to_b, edges.to_c));
  const Quad first = normals[point.corners[0]];
  const Quad normal = unit(first + point.normal_b * (normals[point.corners[1]] - first) +
                           point.normal_c * (normals[point.corners[2]] - first));
  return {normal.x, normal.y, normal.z};
}

/// rad/s, at which the triangle turns.
Vec3 turning(const Edges& edges, const Edges& rates) {
  const Vec3 product = cross(edges.to_b, edges.to_c);
  const double size = length(product);
  if (!(size > 0)) return {};
  const Vec3 normal = (1 / size) * product;
  const Vec3 dual_b = (1 / size) * cross(edges.to_c, normal);
  const Vec3 dual_c = (1 / size) * cross(normal, edges.to_b);
  const Vec3 tilting = -1. * (dot(normal, rates.to_b) * dual_b + dot(normal, rates.to_c) * dual_c);
  const double spin = dot(normal, cross(dual_b, rates.to_b) + cross(dual_c, rates.to_c)) / 2;
  return cross(normal, tilting) + spin * normal;
}

}  // namespace

Following following(Vec3 place, const Triangle& triangle, const Nearest& nearest,
                    std::span<const Vec3> positions, std::span<const Quad> normals) {
  Following point{.corners = triangle,
                  .normal_b = static_cast<float>(nearest.shares[1]),
                  .normal_c = static_cast<float>(nearest.shares[2])};
  const Edges edges = edges_of(triangle, positions);
  const Vec3 product = cross(edges.to_b, edges.to_c);
  Vec3 normal = normal_of(point, edges, normals);
  if (dot(normal, product) < kLeastUpright * length(product)) {
    point.normal_b = Following::kOwn;
    normal = unit(product);
  }
  const Vec3 from_corner = place - positions[triangle[0]];
  const double height = dot(from_corner, product) / dot(normal, product);
  const Vec3 in_plane = from_corner - height * normal;
  const double square = dot(product, product);
  point.b = static_cast<float>(dot(cross(in_plane, edges.to_c), product) / square);
  point.c = static_cast<float>(dot(cross(edges.to_b, in_plane), product) / square);
  point.height = static_cast<float>(height);
  return point;
}

void place_points(std::span<const Following> points, std::span<const Vec3> positions,
                  std::span<const Quad> normals, std::span<Vec3> out) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Following& point = points[i];
    const Edges edges = edges_of(point.corners, positions);
    out[i] = positions[point.corners[0]] + point.b * edges.to_b + point.c * edges.to_c +
             point.height * normal_of(point, edges, normals);
  }
}

void find_velocities(std::span<const Following> points, std::span<const Vec3> positions,
                     std::span<const Vec3> velocities, std::span<const Quad> normals,
                     std::span<Vec3> out) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Following& point = points[i];
    const Edges edges = edges_of(point.corners, positions);
    const Edges rates = edges_of(point.corners, velocities);
    const Vec3 offset = point.height * normal_of(point, edges, normals);
    out[i] = velocities[point.corners[0]] + point.b * rates.to_b + point.c * rates.to_c +
             cross(turning(edges, rates), offset);
  }
}

}  // namespace weft::surface
