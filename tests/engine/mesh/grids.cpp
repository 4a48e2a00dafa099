#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "tests/support/sheets.h"

namespace weft::test::engine_mesh_grids {
namespace {

MeshDescription with_material(MeshDescription mesh) {
  mesh.material = plain_material();
  return mesh;
}

std::map<std::pair<std::uint32_t, std::uint32_t>, double> compliances(const MeshCloth& cloth) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> found;
  for (const Constraint& c : cloth.scene.constraints) found[std::minmax(c.a, c.b)] = c.compliance;
  return found;
}

TEST_CASE("a grid that was cut into triangles is recognised, and is the same cloth") {
  Random random(1);
  const MeshCloth whole = made(with_material(quads(8)));
  CHECK(whole.counts.quads == 49);
  CHECK(whole.counts.recognised_quads == 0);
  for (int kind = 0; kind < 3; ++kind) {
    CAPTURE(kind);
    const MeshCloth cut = made(with_material(sheet(
        8, 8,
        [](double i, double j) {
          return Vec3{i, j, 0};
        },
        [&](std::uint32_t i, std::uint32_t j) {
          const auto choice = kind == 0 ? 0 : kind == 1 ? (i + j) % 2 : random.below(2);
          return choice == 0 ? Cut::first : Cut::second;
        })));
    CHECK(cut.counts.quads == 49);
    CHECK(cut.counts.recognised_quads == 49);
    CHECK(cut.counts.triangles == 0);
    CHECK(cut.scene.bending.size() == whole.scene.bending.size());
    const auto one = compliances(whole), two = compliances(cut);
    REQUIRE(one.size() == two.size());
    for (const auto& [ends, compliance] : one) {
      REQUIRE(two.contains(ends));
      CHECK(two.at(ends) == doctest::Approx(compliance).epsilon(1e-12));
    }
    for (std::size_t i = 0; i < 64; ++i) {
      CHECK(cut.scene.masses[i] == doctest::Approx(whole.scene.masses[i]).epsilon(1e-12));
    }
  }
}

TEST_CASE("a strip of one row of cells is recognised, a single cell is not") {
  MeshDescription strip = sheet(
      2, 9,
      [](double i, double j) {
        return Vec3{i, j, 0};
      },
      [](auto, auto) { return Cut::first; });
  CHECK(made(strip).counts.recognised_quads == 8);
  CHECK(made(right_triangles(2)).counts.recognised_quads == 0);
}

TEST_CASE("a curved grid and a tube are recognised") {
  MeshDescription tube = sheet(
      25, 9,
      [](double i, double j) {
        const double angle = std::numbers::pi * i / 12;
        return Vec3{4 * std::cos(angle), j, 4 * std::sin(angle)};
      },
      [](auto, auto) { return Cut::second; });
  tube.weld_distance = 1e-6;
  const MeshCloth cloth = made(tube);
  CHECK(cloth.scene.positions.size() == 24 * 9);
  CHECK(cloth.counts.recognised_quads == 24 * 8);
}

TEST_CASE("triangles that are right-angled by chance are no grid") {
  Random random(2);
  CHECK(made(equilateral_triangles(12)).counts.recognised_quads == 0);
  CHECK(made(irregular_triangles(30, 0.3, random)).counts.recognised_quads == 0);
}

TEST_CASE("a grid beside other triangles is recognised up to where they begin") {
  const MeshCloth cloth = made(sheet(
      12, 8,
      [](double i, double j) {
        return Vec3{i + (i > 6 ? 0.5 * j : 0), j, 0};
      },
      [](auto, auto) { return Cut::first; }));
  CHECK(cloth.counts.recognised_quads == 6 * 7);
  CHECK(cloth.counts.triangles == 5 * 7 * 2);
}

TEST_CASE(
    "pairs of triangles whose warp runs across them are no cells, and are counted as triangles") {
  MeshDescription mesh = with_material(right_triangles(8));
  REQUIRE(made(mesh).counts.recognised_quads == 49);
  mesh.warp.assign(98, {1, 1, 0});
  const MeshCloth cloth = made(mesh);
  CHECK(cloth.cells.empty());
  CHECK(cloth.counts.recognised_quads == 0);
  CHECK(cloth.counts.quads == 0);
  CHECK(cloth.counts.triangles == 98);
  CHECK(cloth.scene.membrane.size() == 98);
}

TEST_CASE("masses are the areas of the faces, a quarter of each rectangle at its corners") {
  const MeshCloth cloth = made(with_material(quads(3)));
  const double quarter = 0.1 / 4;
  const std::vector<double> shares{1, 2, 1, 2, 4, 2, 1, 2, 1};
  for (std::size_t i = 0; i < 9; ++i) {
    CHECK(cloth.scene.masses[i] == doctest::Approx(quarter * shares[i]).epsilon(1e-12));
  }
  Random random(3);
  MeshDescription triangle;
  triangle.positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}};
  triangle.corners = {0, 1, 2};
  for (const double mass : made(with_material(triangle)).scene.masses) {
    CHECK(mass == doctest::Approx(0.1));
  }
}

TEST_CASE("the mass of a quad of any shape is its area, more of it at wider corners") {
  MeshDescription trapezoid;
  trapezoid.positions = {{0, 0, 0}, {3, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  trapezoid.corners = {0, 1, 2, 3};
  trapezoid.face_sizes = {4};
  const auto masses = made(with_material(trapezoid)).scene.masses;
  CHECK(masses[0] + masses[1] + masses[2] + masses[3] == doctest::Approx(0.2));
  CHECK(masses[0] > masses[3]);
}

TEST_CASE("without a material the mass is shared equally") {
  MeshDescription mesh = quads(3);
  mesh.mass = 3;
  CHECK(made(mesh).scene.masses == std::vector<double>(9, 3.0 / 9));
}

}  // namespace
}  // namespace weft::test::engine_mesh_grids
