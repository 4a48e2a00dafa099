/// Meshes that begin in another shape than they have at rest.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/sheets.h"

namespace weft::test::engine_mesh_rest_shape {
namespace {

/// Rolled up, twice as wide as at rest.
Vec3 rolled(Vec3 p) { return {2 * std::cos(p.x / 3), p.y, 2 * std::sin(p.x / 3)}; }

MeshDescription begun_elsewhere(MeshDescription mesh) {
  mesh.rest_positions = mesh.positions;
  for (Vec3& p : mesh.positions) p = rolled(p);
  return mesh;
}

MeshDescription begun_elsewhere_flat(MeshDescription mesh) {
  for (const std::uint32_t vertex : mesh.corners) {
    mesh.rest_corners.push_back({mesh.positions[vertex].x, mesh.positions[vertex].y});
  }
  for (Vec3& p : mesh.positions) p = rolled(p);
  return mesh;
}

void check_same_cloth(const SceneDescription& one, const SceneDescription& two) {
  CHECK(one.masses == two.masses);
  REQUIRE(one.constraints.size() == two.constraints.size());
  for (std::size_t i = 0; i < one.constraints.size(); ++i) {
    const Constraint &a = one.constraints[i], &b = two.constraints[i];
    CHECK((a.a == b.a && a.b == b.b && a.rest_length == b.rest_length));
    CHECK(a.compliance == b.compliance);
  }
  REQUIRE(one.membrane.size() == two.membrane.size());
  for (std::size_t i = 0; i < one.membrane.size(); ++i) {
    CHECK(one.membrane[i].particles == two.membrane[i].particles);
    CHECK(one.membrane[i].rest == two.membrane[i].rest);
  }
  REQUIRE(one.bending.size() == two.bending.size());
  for (std::size_t i = 0; i < one.bending.size(); ++i) {
    const BendingElement &a = one.bending[i], &b = two.bending[i];
    CHECK((a.particles == b.particles && a.weights == b.weights && a.rest == b.rest &&
           a.fold == b.fold));
    CHECK(a.compliance == b.compliance);
  }
}

TEST_CASE("a cloth is what its rest shape says, and begins where its positions say") {
  Random random(4);
  for (MeshDescription mesh : {quads(5), right_triangles(5), irregular_triangles(6, 0.2, random)}) {
    for (const bool has_material : {true, false}) {
      mesh.material.reset();
      if (has_material) mesh.material = plain_material();
      mesh.pins = {1};
      const SceneDescription plain = made(mesh).scene;
      for (const auto& elsewhere : {begun_elsewhere(mesh), begun_elsewhere_flat(mesh)}) {
        const MeshCloth cloth = made(elsewhere);
        check_same_cloth(cloth.scene, plain);
        CHECK(cloth.counts.recognised_quads == made(mesh).counts.recognised_quads);
        CHECK(cloth.scene.positions[7].x == rolled(mesh.positions[7]).x);
        CHECK(cloth.scene.fixed == std::vector<std::uint32_t>{1});
      }
    }
  }
}

TEST_CASE("lines have their length at rest in space, and with flat corners that of the beginning") {
  MeshDescription mesh = quads(3);
  mesh.lines = {{0, 8}};
  mesh.rest_positions = mesh.positions;
  for (Vec3& p : mesh.rest_positions) p = {3 * p.x, 3 * p.y, 0};
  CHECK(made(mesh).scene.constraints.back().rest_length == doctest::Approx(6 * std::sqrt(2)));
  mesh.rest_positions.clear();
  for (const std::uint32_t vertex : mesh.corners) {
    mesh.rest_corners.push_back({3 * mesh.positions[vertex].x, 3 * mesh.positions[vertex].y});
  }
  const auto& constraints = made(mesh).scene.constraints;
  CHECK(constraints.back().rest_length == doctest::Approx(2 * std::sqrt(2)));
  CHECK(constraints.front().rest_length == 3);
}

/// Faces from `first` on are a panel of their own, elsewhere and turned by a right angle.
MeshDescription of_two_panels(MeshDescription mesh, std::size_t first) {
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    const Vec3 p = mesh.positions[mesh.corners[i]];
    if (i < 4 * first) mesh.rest_corners.push_back({p.x, p.y});
    if (i >= 4 * first) mesh.rest_corners.push_back({100 - p.y, p.x});
  }
  return mesh;
}

TEST_CASE(
    "panels that share vertices are sewn there, each in its own shape, and flat across the seam") {
  MeshDescription one = quads(7);
  one.material = plain_material();
  one.material->weft = one.material->warp;
  const SceneDescription whole = made(one).scene;
  const MeshCloth sewn = made(of_two_panels(one, 3 * 6));
  CHECK(sewn.counts.pieces == 1);
  for (std::size_t i = 0; i < whole.constraints.size(); ++i) {
    CHECK(sewn.scene.constraints[i].rest_length == whole.constraints[i].rest_length);
    CHECK(sewn.scene.constraints[i].compliance ==
          doctest::Approx(whole.constraints[i].compliance).epsilon(1e-12));
  }
  std::vector<Vec3> bent = whole.positions;
  for (Vec3& p : bent) p.z = 0.01 * p.x * p.x;
  CHECK(bending_energy(sewn.scene, bent) ==
        doctest::Approx(bending_energy(whole, bent)).epsilon(1e-9));
  CHECK(bending_energy(sewn.scene, whole.positions) < 1e-30);
}

/// Cut in stripes of this width, each a panel that is turned and moved by chance.
MeshDescription in_stripes(MeshDescription mesh, double width, Random& random) {
  struct Panel {
    double angle, x, y;
  };
  std::vector<Panel> panels;
  for (int i = 0; i < 10; ++i)
    panels.push_back({random.between(0, 6), random.between(-9, 9), random.between(-9, 9)});
  for (std::size_t face = 0; face < mesh.corners.size() / 3; ++face) {
    const auto corners = std::span(mesh.corners).subspan(3 * face, 3);
    double middle = 0;
    for (const std::uint32_t vertex : corners) middle += mesh.positions[vertex].x / 3;
    const Panel& panel = panels[static_cast<std::size_t>(std::max(0.0, middle) / width)];
    const double c = std::cos(panel.angle), s = std::sin(panel.angle);
    for (const std::uint32_t vertex : corners) {
      const Vec3 p = mesh.positions[vertex];
      mesh.rest_corners.push_back({panel.x + c * p.x - s * p.y, panel.y + s * p.x + c * p.y});
    }
  }
  return mesh;
}

TEST_CASE("cloth bends alike in all directions, however its panels lie at rest") {
  Random random(8);
  MeshDescription one = irregular_triangles(20, 0.2, random);
  one.material = plain_material();
  const SceneDescription whole = made(one).scene;
  const SceneDescription sewn = made(in_stripes(one, 4, random)).scene;
  for (int i = 0; i < 8; ++i) {
    const double c = std::cos(0.4 * i), s = std::sin(0.4 * i);
    std::vector<Vec3> bent = whole.positions;
    for (Vec3& p : bent) p.z = 0.01 * (c * p.x + s * p.y) * (c * p.x + s * p.y);
    CHECK(bending_energy(sewn, bent) == doctest::Approx(bending_energy(whole, bent)).epsilon(0.03));
  }
}

TEST_CASE("no cell lies across a seam") {
  MeshDescription mesh = begun_elsewhere_flat(right_triangles(4));
  CHECK(made(mesh).counts.recognised_quads == 9);
  for (std::size_t corner = 0; corner < 3; ++corner) mesh.rest_corners[corner][0] += 0.01;
  CHECK(made(mesh).counts.recognised_quads == 8);
}

TEST_CASE("a rest shape that means nothing is refused by field and value") {
  const auto with = [](auto change) {
    MeshDescription mesh = right_triangles(3);
    change(mesh);
    return refusal(mesh);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(with([](auto& m) { m.rest_positions.resize(8); }) ==
        "rest_positions: needs as many as positions, 9 (8)");
  CHECK(with([](auto& m) { m.rest_corners.resize(9); }) ==
        "rest_corners: needs as many as corners, 24 (9)");
  CHECK(with([](auto& m) {
          m.rest_positions = m.positions;
          m.rest_corners.resize(24);
        }) == "rest_corners: there are rest_positions already");
  CHECK(with([&](auto& m) {
          m.rest_positions = m.positions;
          m.rest_positions[4].y = nan;
        }) == "rest_positions[4]: must be finite (1, nan, 0)");
  CHECK(with([&](auto& m) {
          m.rest_corners.resize(24);
          m.rest_corners[23] = {1, nan};
        }) == "rest_corners[23]: must be finite (1, nan)");
  CHECK(with([](auto& m) {
          m.rest_positions = m.positions;
          m.rest_positions[8] = {1, 1, 0};
        }) == "rest_positions: face 6 has no area at rest");
  CHECK(with([](auto& m) { m.rest_corners.resize(24); }) ==
        "rest_corners: face 0 has no area at rest");
}

TEST_CASE("what has no area at the beginning needs none at rest") {
  MeshDescription mesh = right_triangles(3);
  mesh.corners.insert(mesh.corners.end(), {0, 1, 1});
  mesh.face_sizes.push_back(3);
  mesh.rest_positions = mesh.positions;
  CHECK(made(mesh).counts.degenerate_faces == 1);
}

}  // namespace
}  // namespace weft::test::engine_mesh_rest_shape
