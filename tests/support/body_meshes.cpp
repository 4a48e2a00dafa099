#include "tests/support/body_meshes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "tests/support/vectors.h"

namespace weft::test {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

TriangleMesh icosahedron() {
  const double t = std::numbers::phi;
  return {.vertices = {{-1, t, 0},
                       {1, t, 0},
                       {-1, -t, 0},
                       {1, -t, 0},
                       {0, -1, t},
                       {0, 1, t},
                       {0, -1, -t},
                       {0, 1, -t},
                       {t, 0, -1},
                       {t, 0, 1},
                       {-t, 0, -1},
                       {-t, 0, 1}},
          .triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                        {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                        {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                        {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}}};
}

void subdivide(TriangleMesh& mesh) {
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [found, is_new] = middles.try_emplace(
        {std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
    return found->second;
  };
  std::vector<Triangle> finer;
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const Triangle& t : {Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
      finer.push_back(t);
  }
  mesh.triangles = finer;
}

/// Adds a square from a corner along u and v, its normal along u x v; corners at one place are one.
class Builder {
 public:
  void add(Vec3 corner, Vec3 u, Vec3 v, std::uint32_t cuts) {
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
      return index(corner + (double{1} * i / cuts) * u + (double{1} * j / cuts) * v);
    };
    for (std::uint32_t i = 0; i < cuts; ++i) {
      for (std::uint32_t j = 0; j < cuts; ++j) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  std::uint32_t index(Vec3 x) {
    const auto key = [](double c) { return std::llround(c * 1e9); };
    const auto [found, is_new] = known_.try_emplace(
        {key(x.x), key(x.y), key(x.z)}, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(x);
    return found->second;
  }
  TriangleMesh mesh;

 private:
  std::map<std::array<long long, 3>, std::uint32_t> known_;
};

}  // namespace

TriangleMesh icosphere(double radius, int level) {
  TriangleMesh mesh = icosahedron();
  for (int i = 0; i < level; ++i) subdivide(mesh);
  for (Vec3& v : mesh.vertices) v = (radius / length(v)) * v;
  return mesh;
}

TriangleMesh box_mesh(Vec3 size, std::uint32_t cuts) {
  const Vec3 x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z}, low = -0.5 * (x + y + z);
  Builder box;
  box.add(low, z, y, cuts);
  box.add(low + x, y, z, cuts);
  box.add(low, x, z, cuts);
  box.add(low + y, z, x, cuts);
  box.add(low, y, x, cuts);
  box.add(low + z, x, y, cuts);
  return box.mesh;
}

TriangleMesh plane_mesh(double size, std::uint32_t cuts) {
  Builder plane;
  plane.add({-size / 2, 0, -size / 2}, {0, 0, size}, {size, 0, 0}, cuts);
  return plane.mesh;
}

TriangleMesh knife_mesh(double angle, double depth, double length, std::uint32_t cuts) {
  const double half = depth * std::tan(angle / 2);
  const Vec3 along{0, 0, length}, edge{0, 0, -length / 2};
  Builder knife;
  knife.add(edge, along, {half, -depth, 0}, cuts);
  knife.add(edge, {-half, -depth, 0}, along, cuts);
  return knife.mesh;
}

double inner_radius(const TriangleMesh& mesh) {
  double least = 1e300;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 x = mesh.vertices[a];
    const Vec3 n = cross(mesh.vertices[b] - x, mesh.vertices[c] - x);
    least = std::min(least, dot(n, x) / test::length(n));
  }
  return least;
}

std::shared_ptr<const BodyShape> shape_of(const ShapeDescription& shape) {
  auto built = build_shape(shape);
  REQUIRE_MESSAGE(built, (built ? "" : built.error()));
  return built.value();
}

std::uint32_t add(Cloth& cloth, const Body& body) {
  auto id = cloth.add_body(body);
  REQUIRE_MESSAGE(id, (id ? "" : id.error()));
  return id.value();
}

Vec3 turned(const Rotation& by, Vec3 v) {
  const Vec3 axis{by.x, by.y, by.z};
  const Vec3 t = 2 * cross(axis, v);
  return v + by.w * t + cross(axis, t);
}

Rotation turn(Vec3 axis, double angle) {
  const double s = std::sin(angle / 2);
  return {s * axis.x, s * axis.y, s * axis.z, std::cos(angle / 2)};
}

std::vector<Vec3> placed(const std::vector<Vec3>& vertices, const Pose& pose) {
  std::vector<Vec3> at;
  for (const Vec3 v : vertices) at.push_back(pose.position + turned(pose.rotation, v));
  return at;
}

}  // namespace weft::test
