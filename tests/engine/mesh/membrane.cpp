#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/sheets.h"

namespace weft::test {
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

TEST_CASE("in narrow cells shear falls short, so that warp and weft do not exceed theirs") {
  MeshDescription mesh = with_material(quads(5));
  for (Vec3& p : mesh.positions) p.y *= 10;
  const Material& m = *mesh.material;
  CHECK(density(mesh, {.yy = 1}) == near(m.warp));
  CHECK(density(mesh, {.xx = 1}) == near(m.weft));
  CHECK(density(mesh, {.xy = 0.5}) == near(m.warp / 200));
}

TEST_CASE("without shear there are no diagonals") {
  MeshDescription mesh = with_material(quads(5));
  const std::size_t with_shear = made(mesh).scene.constraints.size();
  mesh.material->shear = 0;
  CHECK(made(mesh).scene.constraints.size() == with_shear - 32);
  CHECK(density(mesh, {.xy = 1}) < 1e-3);
}

TEST_CASE("an irregular grid keeps its stiffness in the mean") {
  Random random(3);
  MeshDescription mesh = with_material(quads(20));
  for (Vec3& p : mesh.positions) {
    p.x += random.between(-0.1, 0.1);
    p.y += random.between(-0.1, 0.1);
  }
  const Material& m = *mesh.material;
  CHECK(density(mesh, {.yy = 1}) == doctest::Approx(m.warp).epsilon(0.05));
  CHECK(density(mesh, {.xx = 1}) == doctest::Approx(m.weft).epsilon(0.05));
}

/// A stretch by e in this direction, nothing across it.
Strain2 stretch(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * c, s * s, c * s};
}

/// Van Gelder's springs of stiffness k have k as their modulus and a Poisson ratio of 1/3 where
/// triangles are equilateral: a stretch alone stores 9/8 k, a shear 3/8 k.
TEST_CASE("equilateral triangles are isotropic, with the mean of warp and weft") {
  const MeshDescription mesh = with_material(equilateral_triangles(7));
  const double k = (mesh.material->warp + mesh.material->weft) / 2;
  for (int i = 0; i < 8; ++i) {
    CHECK(density(mesh, stretch(std::numbers::pi * i / 8)) == near(9.0 / 8 * k));
  }
  CHECK(density(mesh, {.xy = 0.5}) == near(3.0 / 8 * k));
}

/// Elsewhere the mean over directions is that of equilateral ones, and single directions differ:
/// with right angles from 1/2 to 3/2 of k.
TEST_CASE("other triangles have the same stiffness in the mean over directions") {
  Random random(11);
  MeshDescription sheared = sheet(
      9, 9,
      [](double i, double j) {
        return Vec3{i + 0.4 * j, j, 0};
      },
      [](auto, auto) { return Cut::first; });
  MeshDescription right = right_triangles(2);
  for (MeshDescription mesh : {irregular_triangles(20, 0.2, random), sheared, right_triangles(2)}) {
    mesh = with_material(mesh);
    const double k = (mesh.material->warp + mesh.material->weft) / 2;
    double mean = 0;
    for (int i = 0; i < 8; ++i) mean += density(mesh, stretch(std::numbers::pi * i / 8)) / 8;
    CHECK(mean == near(9.0 / 8 * k));
  }
  right = with_material(right);
  const double k = (right.material->warp + right.material->weft) / 2;
  CHECK(density(right, stretch(std::numbers::pi / 4)) == near(1.5 * k));
  CHECK(density(right, stretch(-std::numbers::pi / 4)) == near(0.5 * k));
}

TEST_CASE("irregular triangles are within a tenth in every direction") {
  Random random(12);
  const MeshDescription mesh = with_material(irregular_triangles(30, 0.2, random));
  const double k = (mesh.material->warp + mesh.material->weft) / 2;
  for (int i = 0; i < 8; ++i) {
    CHECK(density(mesh, stretch(std::numbers::pi * i / 8)) ==
          doctest::Approx(9.0 / 8 * k).epsilon(0.1));
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

}  // namespace
}  // namespace weft::test
