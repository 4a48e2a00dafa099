/// Where the warp of a cloth runs.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/sheets.h"

namespace weft::test {
namespace {

Vec3 at_angle(double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return {std::sin(angle), std::cos(angle), 0};
}

MeshDescription with_warp(MeshDescription mesh, Vec3 warp) {
  mesh.material = plain_material();
  mesh.warp = {warp};
  return mesh;
}

/// N/m, of an edge between these particles: the force per strain and the width of a whole cell.
double stiffness(const SceneDescription& scene, std::uint32_t a, std::uint32_t b) {
  const auto found = std::ranges::find_if(scene.constraints, [&](const Constraint& c) {
    return std::minmax(c.a, c.b) == std::minmax(a, b);
  });
  REQUIRE(found != scene.constraints.end());
  return found->rest_length / found->compliance;
}

TEST_CASE("yarns of a grid are warp along the direction that is given, of any length") {
  for (MeshDescription mesh : {quads(5), right_triangles(5)}) {
    for (const double size : {1.0, -2.0, 1e-3}) {
      const SceneDescription scene = made(with_warp(mesh, {size, 0, 0})).scene;
      const SceneDescription usual = made(with_warp(mesh, {0, size, 0})).scene;
      CHECK(stiffness(scene, 6, 11) == doctest::Approx(stiffness(usual, 6, 7)));
      CHECK(stiffness(scene, 6, 7) == doctest::Approx(stiffness(usual, 6, 11)));
      CHECK(stiffness(scene, 6, 11) > 1.5 * stiffness(scene, 6, 7));
    }
  }
}

TEST_CASE("a grid whose edges do not follow the warp is triangles") {
  for (const MeshDescription& mesh : {quads(5), right_triangles(5)}) {
    for (const double angle : {0.0, 90.0, 0.3, 89.7}) {
      CAPTURE(angle);
      CHECK(made(with_warp(mesh, at_angle(angle))).scene.membrane.empty());
    }
    for (const double angle : {3.0, 30.0, 45.0, 80.0}) {
      CAPTURE(angle);
      const SceneDescription scene = made(with_warp(mesh, at_angle(angle))).scene;
      CHECK(scene.constraints.empty());
      CHECK(scene.membrane.size() == 32);
    }
  }
}

TEST_CASE("each face may have a warp of its own") {
  MeshDescription mesh = with_warp(quads(5), {});
  mesh.warp.assign(16, {0, 1, 0});
  mesh.warp[5] = at_angle(45);
  CHECK(made(mesh).scene.membrane.size() == 2);
}

TEST_CASE("no direction, and one across the faces, is as if none were given") {
  const MeshDescription mesh = quads(5);
  const SceneDescription usual = made(with_warp(mesh, {0, 1, 0})).scene;
  for (const Vec3 warp : {Vec3{}, Vec3{0, 0, 1}}) {
    const SceneDescription scene = made(with_warp(mesh, warp)).scene;
    CHECK(stiffness(scene, 6, 7) == stiffness(usual, 6, 7));
  }
}

TEST_CASE("flat places have their warp along v, unless another is given") {
  MeshDescription mesh = with_warp(quads(5), {});
  mesh.warp.clear();
  for (const std::uint32_t vertex : mesh.corners) {
    const Vec3 p = mesh.positions[vertex];
    mesh.rest_corners.push_back({p.y, p.x});
  }
  const SceneDescription turned = made(mesh).scene;
  CHECK(stiffness(turned, 6, 11) > 1.5 * stiffness(turned, 6, 7));
  mesh.warp = {{1, 0, 0}};
  const SceneDescription given = made(mesh).scene;
  CHECK(stiffness(given, 6, 7) > 1.5 * stiffness(given, 6, 11));
}

TEST_CASE("texture coordinates say where the warp runs, on faces of any shape and place") {
  Random random(2);
  MeshDescription mesh = irregular_triangles(6, 0.2, random);
  const auto& positions = mesh.positions;
  for (const double angle : {0.0, 30.0, 80.0}) {
    const Vec3 v = at_angle(angle), u = at_angle(angle + 90);
    std::vector<std::array<double, 2>> texture;
    for (const std::uint32_t vertex : mesh.corners) {
      const Vec3 p = positions[vertex];
      texture.push_back({3 + 2 * (u.x * p.x + u.y * p.y), 5 * (v.x * p.x + v.y * p.y)});
    }
    const auto warp = warp_from_texture(mesh, texture).value();
    REQUIRE(warp.size() == mesh.corners.size() / 3);
    for (const Vec3 w : warp) {
      CHECK(w.x == doctest::Approx(v.x));
      CHECK(w.y == doctest::Approx(v.y));
      CHECK(w.z == 0);
    }
    // Along the cloth and not in space, where it begins folded.
    MeshDescription folded = mesh;
    folded.rest_positions = positions;
    for (Vec3& p : folded.positions) p = {std::abs(p.x - 2), p.y, p.z};
    CHECK(warp_from_texture(folded, texture).value()[7].x == doctest::Approx(v.x));
  }
}

TEST_CASE("of a quad and a polygon the texture counts in the mean") {
  MeshDescription mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {-1, 0, 0.5}};
  mesh.corners = {0, 1, 2, 3, 0, 1, 2, 3, 4, 0, 1, 1};
  mesh.face_sizes = {4, 5, 3};
  std::vector<std::array<double, 2>> texture{{0, 0}, {1, 0}, {1, 1},    {0, 1}, {0, 0}, {0, 1},
                                             {1, 1}, {1, 0}, {0.5, -1}, {2, 2}, {2, 2}, {2, 2}};
  const auto warp = warp_from_texture(mesh, texture).value();
  CHECK(warp[0].z == doctest::Approx(1));
  CHECK(warp[1].x == doctest::Approx(1));
  mesh.corners.back() = 2;
  CHECK(warp_from_texture(mesh, texture).error() == "texture: face 2 has no area");
}

TEST_CASE("a warp that means nothing is refused by field and value") {
  MeshDescription mesh = quads(3);
  mesh.warp.resize(3);
  CHECK(refusal(mesh) == "warp: needs one for all, or as many as faces, 4 (3)");
  mesh.warp.assign(4, {0, 1, 0});
  mesh.warp[2].x = std::numeric_limits<double>::infinity();
  CHECK(refusal(mesh) == "warp[2]: must be finite (inf, 1, 0)");
  CHECK(warp_from_texture(quads(3), std::vector<std::array<double, 2>>(3)).error() ==
        "texture: needs as many as corners, 16 (3)");
}

}  // namespace
}  // namespace weft::test
