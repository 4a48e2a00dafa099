/// Thin triangles of fabric: edges against which the angles are wide are flipped.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/clothes.h"
#include "tests/support/membrane.h"
#include "tests/support/sheets.h"

namespace weft::test::engine_mesh_needles {
namespace {

constexpr std::uint32_t kSize = 12;
constexpr std::uint32_t kMoved = 5 * kSize + 6;

/// A metre of right-angled triangles that no grid is recognised in. One vertex inside comes as near
/// to the diagonal beside it as this share of the diagonal.
MeshDescription with_needle(double height) {
  MeshDescription mesh = right_triangles(kSize);
  for (Vec3& p : mesh.positions) p.y -= 0.3 * p.x;
  const Vec3 a = mesh.positions[kMoved - 1], b = mesh.positions[kMoved + kSize];
  const double x = b.x - a.x, y = b.y - a.y;
  mesh.positions[kMoved] = {(a.x + b.x) / 2 - height * y, (a.y + b.y) / 2 + height * x, 0};
  for (Vec3& p : mesh.positions) p = {p.x / (kSize - 1), p.y / (kSize - 1), 0};
  mesh.material = find_material("cotton").value();
  mesh.material->damping_motion = 3;
  return mesh;
}

/// Of all triangles of fabric: the smallest height, as a share of the longest side.
double thinnest(const SceneDescription& scene) {
  double least = 1;
  for (const MembraneElement& e : scene.membrane) {
    const auto& [a, b, c] = e.rest;
    const double twice = std::abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    const double longest =
        std::max({std::hypot(b[0] - a[0], b[1] - a[1]), std::hypot(c[0] - b[0], c[1] - b[1]),
                  std::hypot(a[0] - c[0], a[1] - c[1])});
    least = std::min(least, twice / (longest * longest));
  }
  return least;
}

TEST_CASE("no triangle is thin whose long side has a neighbour; mass and area stay") {
  const MeshDescription mesh = with_needle(1e-4);
  const SceneDescription scene = made(mesh).scene;
  CHECK(scene.membrane.size() == 2 * (kSize - 1) * (kSize - 1));
  CHECK(thinnest(scene) > 0.1);
  CHECK(area_of(scene) == doctest::Approx(1).epsilon(1e-12));
  CHECK(area_of(scene, *mesh.material) == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("a sheet with a needle stores what the material says, however it is stretched") {
  const MeshDescription mesh = with_needle(1e-4);
  const Material& m = *mesh.material;
  const SceneDescription scene = made(mesh).scene;
  const Fabric fabric{m.warp, m.weft, m.shear, m.density, std::acos(0.0)};
  for (const Affine& affine : {Affine{{1.1, 0, 0}, {0, 1, 0}},
                               {{1, 0.2, 0}, {-0.1, 0.9, 0}},
                               {{1, 0, 0.3}, {0.2, 1.2, 0}}}) {
    std::vector<Vec3> positions = scene.positions;
    for (Vec3& p : positions) p = affine(p);
    CHECK(fabric_energy(scene, positions) ==
          doctest::Approx(energy_density(fabric, affine)).epsilon(1e-9));
  }
}

using Corners = std::array<std::uint32_t, 3>;
Corners sorted(Corners corners) {
  std::ranges::sort(corners);
  return corners;
}

std::vector<Corners> triangles_of(const MeshDescription& mesh) {
  std::vector<Corners> triangles;
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3)
    triangles.push_back({mesh.corners[i], mesh.corners[i + 1], mesh.corners[i + 2]});
  return triangles;
}

std::vector<Corners> triangles_of(const SceneDescription& scene) {
  std::vector<Corners> triangles;
  for (const MembraneElement& e : scene.membrane) triangles.push_back(e.particles);
  return triangles;
}

TEST_CASE("well-shaped triangles stay as they are, in their order") {
  Random random(8);
  MeshDescription mesh = irregular_triangles(20, 0.1, random);
  mesh.material = plain_material();
  CHECK(triangles_of(made(mesh).scene) == triangles_of(mesh));
}

/// Two flat triangles on a long edge, the second turned about it by this angle.
MeshDescription folded(double angle) {
  MeshDescription mesh;
  mesh.positions = {
      {-1, 0, 0}, {1, 0, 0}, {0, 0.5, 0}, {0, -0.5 * std::cos(angle), 0.5 * std::sin(angle)}};
  mesh.corners = {0, 1, 2, 1, 0, 3};
  mesh.material = plain_material();
  return mesh;
}

bool is_flipped(const MeshDescription& mesh) {
  const auto triangles = triangles_of(made(mesh).scene);
  return std::ranges::find(triangles, Corners{0, 1, 2}, sorted) == triangles.end();
}

TEST_CASE("edges stay where the surface is folded at rest, or the warp changes") {
  CHECK(is_flipped(folded(0)));
  CHECK(is_flipped(folded(0.1)));
  CHECK_FALSE(is_flipped(folded(0.5)));
  CHECK_FALSE(is_flipped(folded(3)));
  MeshDescription flat = folded(0);
  flat.warp = {{1, 0, 0}, {-1, 0.1, 0}};
  CHECK(is_flipped(flat));
  flat.warp[1] = {1, 1, 0};
  CHECK_FALSE(is_flipped(flat));
}

TEST_CASE("a thin triangle takes the warp of its neighbour, whichever it has") {
  MeshDescription mesh = folded(0);
  mesh.positions[2].y = 1e-4;
  mesh.warp = {{0, 1, 0}, {1, 0, 0}};
  REQUIRE(is_flipped(mesh));
  for (const MembraneElement& e : made(mesh).scene.membrane) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 a = mesh.positions[e.particles[0]], b = mesh.positions[e.particles[i]];
      CHECK(std::abs(e.rest[i][0]) == doctest::Approx(std::abs(b.x - a.x)).epsilon(1e-3));
    }
  }
}

struct Hung {
  double strain = 0;
  std::vector<Vec3> positions;  ///< but of the vertex that differs
};
/// By two corners, for three seconds, until they hang still.
Hung hung(MeshDescription mesh) {
  mesh.pins = {0, kSize * (kSize - 1)};
  SceneDescription scene = made(mesh).scene;
  scene.gravity = {0, 0, -10};
  Cloth cloth = cloth_of(scene, {});
  Hung result;
  for (int i = 0; i < 180; ++i) {
    const StepReport report = step(cloth, 1.0 / 60);
    CHECK(report.status == Status::converged);
    result.strain = std::max(result.strain, report.max_strain);
  }
  result.positions = positions(cloth);
  result.positions.erase(result.positions.begin() + kMoved);
  return result;
}

TEST_CASE("a sheet with a needle hangs as one without, and is strained as little") {
  const Hung without = hung(with_needle(0.2)), with = hung(with_needle(1e-4));
  CHECK(with.strain < 1.05 * without.strain);
  CHECK(largest_distance(with.positions, without.positions) < 0.01);
}

}  // namespace
}  // namespace weft::test::engine_mesh_needles
