#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/sheets.h"

namespace weft::test::engine_mesh_membrane {
namespace {

/// A plane deformation x -> x + E x, small enough for springs to be linear in it.
struct Strain2 {
  double xx = 0, yy = 0, xy = 0;  ///< sheared by the angle 2 xy
};

/// Energy per area, over k e^2 / 2 with k = 1 N/m.
double density(const MeshDescription& mesh, Strain2 strain) {
  constexpr double kSmall = 1e-6;
  const SceneDescription scene = made(mesh).scene;
  std::vector<Vec3> positions = scene.positions;
  for (Vec3& p : positions) {
    const double x = p.x, y = p.y;
    p.x += kSmall * (strain.xx * x + strain.xy * y);
    p.y += kSmall * (strain.xy * x + strain.yy * y);
  }
  const double energy = membrane_energy(scene, positions);
  return energy / (kSmall * kSmall / 2) / area_of(scene, *mesh.material);
}

MeshDescription with_material(MeshDescription mesh) {
  mesh.material = plain_material();
  return mesh;
}

doctest::Approx near(double value) { return doctest::Approx(value).epsilon(1e-4); }

TEST_CASE("a grid has the stiffness of warp, weft and shear, whatever its spacing") {
  for (const auto& [dx, dy] : {std::pair{1.0, 1.0}, {1.0, 2.0}, {0.02, 0.01}}) {
    CAPTURE(dx);
    CAPTURE(dy);
    MeshDescription mesh = with_material(quads(5));
    for (Vec3& p : mesh.positions) p = {dx * p.x, dy * p.y, 0};
    const Material& m = *mesh.material;
    const double along_y = density(mesh, {.yy = 1}), along_x = density(mesh, {.xx = 1});
    CHECK(along_y == near(m.warp));
    CHECK(along_x == near(m.weft));
    CHECK(density(mesh, {.xy = 0.5}) == near(m.shear));
    // What diagonals add where both stretch: each carries shear / 2 of either, and twice the
    // product.
    CHECK(density(mesh, {.xx = 1, .yy = 1}) == near(along_x + along_y + 2 * m.shear));
  }
}

TEST_CASE("warp runs along y where it can tell, else along x") {
  MeshDescription mesh = with_material(quads(5));
  for (Vec3& p : mesh.positions) p = {p.x, 0, p.y};
  const SceneDescription scene = made(mesh).scene;
  const auto along = [&](double Vec3::*axis) {
    double least = 1;
    for (const Constraint& c : scene.constraints) {
      const double run = std::abs(scene.positions[c.a].*axis - scene.positions[c.b].*axis);
      if (run > 0.9 && c.rest_length < 1.1) least = std::min(least, c.compliance);
    }
    return least;
  };
  CHECK(along(&Vec3::x) < along(&Vec3::z));
}

TEST_CASE("a grid that was rotated, renumbered and turned about face by face is the same cloth") {
  Random random(5);
  const MeshDescription plain = with_material(quads(6));
  MeshDescription mixed = plain;
  for (std::size_t f = 0; f < mixed.face_sizes.size(); ++f) {
    const auto begin = mixed.corners.begin() + static_cast<std::ptrdiff_t>(4 * f);
    std::rotate(begin, begin + random.below(4), begin + 4);
    if (random.below(2) == 0) std::reverse(begin, begin + 4);
  }
  for (const Strain2 strain : {Strain2{.xx = 1}, {.yy = 1}, {.xy = 1}, {1, 2, 3}}) {
    CHECK(density(mixed, strain) == near(density(plain, strain)));
  }
}

TEST_CASE("cells so narrow that diagonals would carry all of the warp are triangles") {
  MeshDescription mesh = with_material(quads(5));
  for (Vec3& p : mesh.positions) p.y *= 10;
  const Material& m = *mesh.material;
  CHECK(density(mesh, {.yy = 1}) == near(m.warp));
  CHECK(density(mesh, {.xx = 1}) == near(m.weft));
  CHECK(density(mesh, {.xy = 0.5}) == near(m.shear));
}

TEST_CASE("without shear there are no diagonals") {
  MeshDescription mesh = with_material(quads(5));
  const std::size_t with_shear = made(mesh).scene.constraints.size();
  mesh.material->shear = 0;
  CHECK(made(mesh).scene.constraints.size() == with_shear - 32);
  CHECK(density(mesh, {.xy = 1}) < 1e-3);
}

/// A stretch by e in this direction, nothing across it.
Strain2 stretch(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * c, s * s, c * s};
}

/// What the material says of it: its warp runs along y.
double density_of(const Material& m, Strain2 strain) {
  return m.warp * strain.yy * strain.yy + m.weft * strain.xx * strain.xx +
         m.shear * 4 * strain.xy * strain.xy;
}

/// In directions between warp and weft shear is all that resists, and a deformation has a hundred
/// times the energy that its shear has: it is shear alone that tells whether cells are skewed.
void check_material(const MeshDescription& mesh, double error) {
  const Material& m = *mesh.material;
  CHECK(density(mesh, {.xy = 0.5}) == doctest::Approx(m.shear).epsilon(error));
  for (int i = 0; i < 8; ++i) {
    CAPTURE(i);
    const Strain2 strain = stretch(std::numbers::pi * i / 8);
    CHECK(density(mesh, strain) == doctest::Approx(density_of(m, strain)).epsilon(error));
  }
}

MeshDescription jittered(MeshDescription mesh, double by, Random& random) {
  for (Vec3& p : mesh.positions) {
    p.x += random.between(-by, by);
    p.y += random.between(-by, by);
  }
  return mesh;
}

TEST_CASE("triangles of any shape have the warp, the weft and the shear of the material") {
  Random random(11);
  const MeshDescription sheared = sheet(
      9, 9,
      [](double i, double j) {
        return Vec3{i + 0.4 * j, j, 0};
      },
      [](auto, auto) { return Cut::first; });
  for (const MeshDescription& mesh :
       {equilateral_triangles(7), irregular_triangles(20, 0.2, random), sheared, right_triangles(2),
        jittered(right_triangles(20), 0.25, random)}) {
    const MeshDescription cloth = with_material(mesh);
    CHECK(made(cloth).scene.membrane.size() > 0);
    check_material(cloth, 1e-4);
  }
}

TEST_CASE("grids whose corners are moved have the stiffness of the material") {
  Random random(3);
  for (const double by : {0.01, 0.03, 0.08, 0.12, 0.25}) {
    for (const bool is_cut : {false, true}) {
      CAPTURE(by);
      CAPTURE(is_cut);
      MeshDescription grid = jittered(is_cut ? right_triangles(20) : quads(20), by, random);
      grid.material = find_material("cotton").value();
      check_material(grid, 0.03);
    }
  }
}

/// Opposite sides of its cells are tilted to opposite sides.
MeshDescription flared(double by) {
  return with_material(sheet(
      10, 10,
      [&](double i, double j) {
        return Vec3{(i - 4.5) * (1 + by * j), j, 0};
      },
      [](auto, auto) { return Cut::none; }));
}

TEST_CASE("the sides of cells that widen carry some of the shear, and diagonals the rest") {
  const MeshDescription mesh = with_material(sheet(
      10, 3,
      [](double i, double j) {
        const double angle = 0.02 * (j - 1), radius = 50 - i;
        return Vec3{radius * std::sin(angle), -radius * std::cos(angle), 0};
      },
      [](auto, auto) { return Cut::none; }));
  CHECK(made(mesh).scene.membrane.empty());
  CHECK(density(mesh, {.xy = 0.5}) == doctest::Approx(mesh.material->shear).epsilon(0.03));
  CHECK(made(flared(0.1)).scene.membrane.size() > 0);
}

TEST_CASE("a curved grid is woven along its cells, and triangles between them continue it") {
  const auto turned = [](double angle) {
    MeshDescription mesh = sheet(
        9, 9,
        [](double i, double j) {
          return Vec3{i, j, 0};
        },
        [](std::uint32_t i, std::uint32_t j) { return i == 4 && j == 4 ? Cut::first : Cut::none; });
    // Vertices around the cut cell: its triangles are no cell of a grid.
    mesh.positions[4 * 9 + 4].x += 0.3;
    const double c = std::cos(angle), s = std::sin(angle);
    for (Vec3& p : mesh.positions) p = {c * p.x - s * p.y, s * p.x + c * p.y, 0};
    return with_material(mesh);
  };
  const SceneDescription straight = made(turned(0)).scene, rotated = made(turned(0.5)).scene;
  REQUIRE(straight.membrane.size() == rotated.membrane.size());
  CHECK(straight.membrane.size() >= 2);
  for (std::size_t i = 0; i < straight.membrane.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto one = straight.membrane[i].rest[k], two = rotated.membrane[i].rest[k];
      CHECK(std::abs(one[0]) == doctest::Approx(std::abs(two[0])).epsilon(1e-9));
      CHECK(std::abs(one[1]) == doctest::Approx(std::abs(two[1])).epsilon(1e-9));
    }
  }
}

TEST_CASE("ropes are what was asked for, springs or not") {
  const auto ropes = [](const SceneDescription& scene) {
    return std::ranges::count(scene.constraints, ConstraintKind::rope, &Constraint::kind);
  };
  MeshDescription mesh = quads(3);
  mesh.lines = {{0, 8}};
  mesh.ropes = Ropes::all;
  CHECK(ropes(made(mesh).scene) == 13);
  mesh.ropes = Ropes::diagonals;
  CHECK(ropes(made(mesh).scene) == 8);
  mesh.material = plain_material();
  CHECK(ropes(made(mesh).scene) == 8);
  mesh.ropes = Ropes::all;
  CHECK(ropes(made(mesh).scene) == 21);
  mesh.ropes = Ropes::none;
  CHECK(ropes(made(mesh).scene) == 0);
}

TEST_CASE("lines are threads: rigid, unless a face has the same edge") {
  MeshDescription mesh = with_material(quads(3));
  mesh.lines = {{0, 1}, {0, 8}};
  const SceneDescription scene = made(mesh).scene;
  CHECK(std::ranges::count(scene.constraints, 0.0, &Constraint::compliance) == 1);
  CHECK(scene.constraints.back().b == 8);
}

TEST_CASE("threads hang off the cloth by their own mass, half of it at either end") {
  MeshDescription mesh = with_material(quads(3));
  const std::vector<double> cloth = made(mesh).scene.masses;
  mesh.positions.push_back({0, -2, 0});
  mesh.positions.push_back({0, -2, 1});
  mesh.lines = {{0, 9}, {9, 10}, {0, 1}};
  mesh.thread_density = 0.01;
  const MeshCloth made_of = made(mesh);
  CHECK(made_of.counts.thread_lines == 2);
  CHECK(made_of.counts.pieces == 1);
  const auto& masses = made_of.scene.masses;
  CHECK(masses[0] == doctest::Approx(cloth[0] + 0.01));
  CHECK(masses[1] == cloth[1]);
  CHECK(masses[9] == doctest::Approx(0.015));
  CHECK(masses[10] == doctest::Approx(0.005));
  CHECK(build_model(made_of.scene));
}

TEST_CASE("threads may be all that there is") {
  MeshDescription mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.lines = {{0, 1}, {1, 2}};
  mesh.material = plain_material();
  CHECK(made(mesh).scene.masses == std::vector<double>{0.5e-3, 1e-3, 0.5e-3});
  mesh.thread_density = 0;
  CHECK(refusal(mesh) == "thread_density: must be finite and greater than 0 (0)");
}

}  // namespace
}  // namespace weft::test::engine_mesh_membrane
