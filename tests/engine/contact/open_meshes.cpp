/// Cloth beside a mesh that has a border, on either side of it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_open_meshes {
namespace {

constexpr double kG = 10;  // m/s^2
constexpr double kDegree = std::numbers::pi / 180;

/// A floor of 1 m at y = 0.
TriangleMesh floor_mesh(std::uint32_t cuts, bool faces_up) {
  TriangleMesh floor = plane_mesh(1, cuts);
  for (auto& corners : floor.triangles) {
    if (!faces_up) std::swap(corners[0], corners[1]);
  }
  return floor;
}

struct Lie {
  double lowest = 0, highest = 0;  // m
  double way = 0;                  // m, down the incline, in the mean
};

/// A square of cotton of 0.3 m above the floor, where all is turned by the angle.
Lie lie(const TriangleMesh& floor, std::uint32_t size, double height, double angle, double rate,
        double time) {
  MeshDescription mesh = quads(size);
  const double spacing = 0.3 / (size - 1);
  for (Vec3& v : mesh.positions) v = {spacing * v.x - 0.15, height, spacing * v.y - 0.15};
  mesh.material = find_material("cotton").value();
  SceneDescription scene = made(mesh).scene;
  scene.gravity = {kG * std::sin(angle), -kG * std::cos(angle), 0};
  scene.friction = 0.3;
  Cloth cloth = cloth_of(scene, {.solver = Solver::small_steps, .threads = 1});
  add(cloth, {.shape = shape_of(floor), .friction = 0.3});
  const std::vector<Vec3> start = positions(cloth);
  const auto frames = std::lround(rate * time);
  for (long i = 0; i < frames; ++i) {
    const StepReport report = step(cloth, 1 / rate);
    CHECK(report.status == Status::converged);
    CHECK(report.intersecting == 0);
  }
  Lie found{.lowest = height};
  for (std::uint32_t i = 0; i < start.size(); ++i) {
    const Vec3 x = cloth.position(i);
    found.lowest = std::min(found.lowest, x.y);
    found.highest = std::max(found.highest, x.y);
    found.way += (x.x - start[i].x) / static_cast<double>(start.size());
  }
  return found;
}

TEST_CASE("cloth lies at its thickness on either side of an open mesh, and sticks there" *
          doctest::test_suite("long")) {
  for (const bool faces_up : {true, false}) {
    for (const double height : {0.9e-3, 1.2e-3, 2e-3}) {
      for (const auto& [size, cuts] : {std::pair{7u, 1u}, std::pair{13u, 9u}}) {
        for (const double rate : {30.0, 60.0, 240.0}) {
          CAPTURE(faces_up);
          CAPTURE(height);
          CAPTURE(size);
          CAPTURE(rate);
          const Lie there = lie(floor_mesh(cuts, faces_up), size, height, 10 * kDegree, rate, 1);
          CHECK(there.lowest == doctest::Approx(1e-3).epsilon(0.02));
          CHECK(there.highest == doctest::Approx(1e-3).epsilon(0.02));
          CHECK(std::abs(there.way) < 3e-4);  // it falls 1 mm aslant
        }
      }
    }
  }
}

TEST_CASE("cloth slides alike on both sides of an open mesh, by Coulomb's law") {
  const double angle = 25 * kDegree;
  const double a = kG * (std::sin(angle) - 0.3 * std::cos(angle));
  for (const bool faces_up : {true, false}) {
    for (const double rate : {30.0, 60.0, 240.0}) {
      CAPTURE(faces_up);
      CAPTURE(rate);
      const Lie there = lie(floor_mesh(9, faces_up), 9, 1e-3, angle, rate, 0.3);
      CHECK(there.way == doctest::Approx(a * 0.3 * 0.3 / 2).epsilon(0.02));
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_contact_open_meshes
