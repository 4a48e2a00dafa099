/// Where the warp of a cloth runs.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/sheets.h"

namespace weft::test::engine_mesh_warp {
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
    for (const double angle : {4.0, 30.0, 45.0, 80.0}) {
      CAPTURE(angle);
      const SceneDescription scene = made(with_warp(mesh, at_angle(angle))).scene;
      CHECK(scene.constraints.empty());
      CHECK(scene.membrane.size() == 32);
    }
  }
}

/// J per m^2, by the law: of the strains that a plane deformation x + D x makes along the warp, the
/// weft, and between them.
double by_law(const Material& m, Vec3 warp, const std::array<double, 4>& d) {
  const auto deformed = [&](double x, double y) {
    return std::array{x + d[0] * x + d[1] * y, y + d[2] * x + d[3] * y};
  };
  const auto u = deformed(warp.x, warp.y), v = deformed(-warp.y, warp.x);
  const double along = std::hypot(u[0], u[1]), across = std::hypot(v[0], v[1]);
  const double shear = (u[0] * v[0] + u[1] * v[1]) / (along * across);
  return (m.warp * (along - 1) * (along - 1) + m.weft * (across - 1) * (across - 1) +
          m.shear * shear * shear) /
         2;
}

TEST_CASE("pulled along any direction, cloth has the stiffness of its warp and weft there") {
  Random random(6);
  for (MeshDescription mesh : {quads(6), right_triangles(6), irregular_triangles(8, 0.2, random)}) {
    for (const double angle : {0.0, 30.0, 45.0, 80.0, 123.0}) {
      CAPTURE(angle);
      const MeshDescription given = with_warp(mesh, at_angle(angle));
      const SceneDescription scene = made(given).scene;
      const double area = area_of(scene, *given.material);
      for (const std::array<double, 4> d :
           {std::array{0.01, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.01}, {0.0, 0.01, 0.01, 0.0}}) {
        std::vector<Vec3> pulled = scene.positions;
        for (Vec3& p : pulled)
          p = {p.x + d[0] * p.x + d[1] * p.y, p.y + d[2] * p.x + d[3] * p.y, 0};
        CHECK(membrane_energy(scene, pulled) / area ==
              doctest::Approx(by_law(*given.material, at_angle(angle), d)).epsilon(0.01));
      }
    }
  }
}

TEST_CASE("each face may have a warp of its own") {
  MeshDescription mesh = with_warp(quads(5), {});
  mesh.warp.assign(16, {0, 1, 0});
  mesh.warp[5] = at_angle(45);
  CHECK(made(mesh).scene.membrane.size() == 2);
}

TEST_CASE(
    "where no direction is given, or one across the face, it is that of the faces beside it") {
  for (const Vec3 none : {Vec3{}, Vec3{0, 0, 1}}) {
    MeshDescription mesh = with_warp(quads(5), {});
    mesh.warp.assign(16, {1, 0, 0});
    mesh.warp[5] = none;
    const SceneDescription scene = made(mesh).scene;
    CHECK(scene.membrane.empty());
    const SceneDescription whole = made(with_warp(quads(5), {1, 0, 0})).scene;
    for (std::size_t i = 0; i < whole.constraints.size(); ++i)
      CHECK(scene.constraints[i].compliance == whole.constraints[i].compliance);
    // Nowhere at all: as if none were asked for.
    CHECK(stiffness(made(with_warp(quads(5), none)).scene, 6, 7) ==
          stiffness(made(with_warp(quads(5), {0, 1, 0})).scene, 6, 7));
  }
}

TEST_CASE("a warp goes on around a corner, where it lies across the faces beyond") {
  // Three rows of cells that stand along y, and then two that lie along z.
  MeshDescription mesh = quads(6);
  for (Vec3& p : mesh.positions) p = {p.x, std::min(p.y, 3.0), std::max(p.y - 3, 0.0)};
  const SceneDescription scene = made(with_warp(mesh, {0, 1, 0})).scene;
  CHECK(stiffness(scene, 6, 7) > 1.5 * stiffness(scene, 7, 13));
  CHECK(stiffness(scene, 10, 11) > 1.5 * stiffness(scene, 10, 16));
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
}  // namespace weft::test::engine_mesh_warp
