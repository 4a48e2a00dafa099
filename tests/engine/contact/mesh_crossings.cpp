/// Cloth on bodies of triangles: in no frame do its triangles cross or touch theirs, by exact
/// predicates that know nothing of weft (support/crossing_triangles.h).
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/crossing_triangles.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_mesh_crossings {
namespace {

/// A square of cotton of 0.5 m, level, its middle at the place.
MeshCloth level_sheet(std::uint32_t size, Vec3 middle, bool irregular) {
  Random random(11);
  MeshDescription mesh = irregular ? irregular_triangles(size, 0.2, random) : quads(size);
  const double spacing = 0.5 / (size - 1);
  for (Vec3& v : mesh.positions)
    v = middle + Vec3{spacing * v.x - 0.25, 0.001 * std::sin(7 * v.x), spacing * v.y - 0.25};
  mesh.material = find_material("cotton").value();
  return made(mesh);
}

struct Scene {
  MeshCloth sheet;
  TriangleMesh mesh;
  Body body{};
  double hz = 60, time = 1;
  Vec3 velocity{};
  bool moves = false;
  /// Where the body is at a time; its vertices there, in its own coordinates.
  std::function<Pose(double)> pose = [](double) { return Pose{}; };
  std::function<std::vector<Vec3>(double)> vertices = nullptr;
};

/// Returns how many contacts there were in the last frame.
int run(const Scene& scene, Backend backend) {
  Cloth cloth = cloth_of(scene.sheet.scene,
                         {.solver = Solver::small_steps, .backend = backend, .threads = 1});
  if (length(scene.velocity) > 0) {
    const std::vector<Vec3> all(scene.sheet.scene.positions.size(), scene.velocity);
    REQUIRE(cloth.write_velocities(all));
  }
  Body body = scene.body;
  body.shape = shape_of(scene.mesh);
  body.pose = scene.pose(0);
  const auto id = add(cloth, body);
  const int frames = static_cast<int>(std::lround(scene.time * scene.hz));
  StepReport report;
  for (int i = 1; i <= frames; ++i) {
    const double now = i / scene.hz;
    if (scene.moves) REQUIRE(cloth.move_body(id, scene.pose(now)));
    const std::vector<Vec3> vertices = scene.vertices ? scene.vertices(now) : scene.mesh.vertices;
    if (scene.vertices) REQUIRE(cloth.move_body_vertices(id, vertices));
    report = step(cloth, 1 / scene.hz);
    CAPTURE(i);
    CAPTURE(name(report.status));
    CHECK(committed(report.status));
    CHECK(report.intersecting == 0);
    if (report.status == Status::converged) CHECK(report.max_penetration < 1e-4);
    CHECK(report.max_penetration < 0.01);
    const std::vector<Vec3> x = positions(cloth), at = placed(vertices, scene.pose(now));
    const int crossings =
        count_crossings({x, scene.sheet.scene.surface}, {at, scene.mesh.triangles});
    CHECK(crossings == 0);
    if (crossings != 0) break;
  }
  return report.body_contacts;
}

TEST_CASE("the check itself finds what crosses and what touches") {
  const std::vector<std::array<std::uint32_t, 3>> one{{0, 1, 2}};
  const std::vector<Vec3> flat{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const auto crossings = [&](const std::vector<Vec3>& other) {
    return count_crossings({flat, one}, {other, one});
  };
  CHECK(crossings({{0.2, 0.2, -1}, {0.2, 0.2, 1}, {3, 3, 1}}) == 1);
  CHECK(crossings({{0.2, 0.2, 0}, {0.2, 0.2, 1}, {3, 3, 1}}) == 1);
  CHECK(crossings({{0.2, 0.2, 1e-12}, {0.2, 0.2, 1}, {3, 3, 1}}) == 0);
  CHECK(crossings({{0.2, 0.2, -1}, {0.2, 0.2, 1}, {0.2, 0.2, 0}}) == 1);
  CHECK(crossings({{0.2, 0.2, 1}, {0.2, 0.2, 1}, {0.2, 0.2, 1}}) == 0);
}

TEST_CASE("a sheet that falls on a sphere does not cross it") {
  for (const double hz : {30.0, 60.0, 240.0}) {
    for (const int level : {1, 3}) {
      CAPTURE(hz);
      CAPTURE(level);
      Scene scene{.sheet = level_sheet(20, {0.02, 0.16, 0.01}, level == 3),
                  .mesh = icosphere(0.12, level),
                  .hz = hz,
                  .time = 0.5};
      CHECK(run(scene, Backend::simd) > 10);
    }
  }
}

TEST_CASE("nor one on the corner of a box or on a knife, finer or coarser than it is") {
  for (const std::uint32_t cuts : {1u, 12u}) {
    for (const bool irregular : {false, true}) {
      CAPTURE(cuts);
      CAPTURE(irregular);
      Scene box{.sheet = level_sheet(14, {0.013, 0.2, 0.007}, irregular),
                .mesh = box_mesh({0.2, 0.2, 0.2}, cuts),
                .time = 0.7};
      const Rotation up =
          turn({1 / std::sqrt(2), 0, -1 / std::sqrt(2)}, std::acos(std::sqrt(1. / 3)));
      box.pose = [up](double) { return Pose{{}, up}; };
      CHECK(run(box, Backend::simd) > 0);
      Scene knife{.sheet = level_sheet(14, {0.013, 0.02, 0.007}, irregular),
                  .mesh = knife_mesh(0.2, 0.6, 0.8, cuts),
                  .time = 0.7};
      CHECK(run(knife, Backend::simd) > 0);
    }
  }
}

TEST_CASE("nor one that a sphere runs into") {
  const Backend backend = each_backend();
  Scene runs{.sheet = level_sheet(14, {0, 0, 0}, true), .mesh = icosphere(0.1, 2), .time = 0.4};
  runs.moves = true;
  runs.pose = [](double t) { return Pose{{0, -0.2 + 4 * t, 0}, turn({0, 0, 1}, 3 * t)}; };
  run(runs, backend);
}

TEST_CASE("nor one beside a box that spins") {
  const Backend backend = each_backend();
  Scene spins{.sheet = level_sheet(14, {0.01, 0.12, 0}, true),
              .mesh = box_mesh({0.3, 0.1, 0.12}, 4),
              .body = {.shape = nullptr, .friction = 0.6},
              .time = 0.5};
  spins.moves = true;
  spins.pose = [](double t) { return Pose{{}, turn({0, 0.6, 0.8}, 50 * t)}; };
  run(spins, backend);
}

TEST_CASE("nor one on a body that deforms") {
  const Backend backend = each_backend();
  Scene deforms{
      .sheet = level_sheet(14, {0.01, 0.13, 0}, true), .mesh = icosphere(0.1, 2), .time = 0.6};
  const std::vector<Vec3> rest = deforms.mesh.vertices;
  deforms.vertices = [rest](double t) {
    std::vector<Vec3> all = rest;
    const double swell = 1 + 0.3 * std::sin(12 * t);
    for (Vec3& v : all) v = {v.x * swell, v.y * (2 - swell), v.z + 0.2 * v.y * std::sin(9 * t)};
    return all;
  };
  run(deforms, backend);
}

TEST_CASE("nor one that is thrown at a body, of little thickness too") {
  struct Throw {
    double thickness, speed;
  };
  for (const auto [thickness, speed] : {Throw{1e-3, 15}, {1e-5, 15}}) {
    CAPTURE(thickness);
    Scene thrown{.sheet = level_sheet(14, {0.01, 0.14, 0.003}, true),
                 .mesh = icosphere(0.1, 2),
                 .body = {.shape = nullptr, .thickness = thickness, .friction = 0},
                 .time = 0.3,
                 .velocity = {1, -speed, 0}};
    run(thrown, Backend::simd);
  }
}

TEST_CASE("nor one beside a two-sided sheet, on either side") {
  for (const double side : {-1.0, 1.0}) {
    CAPTURE(side);
    Scene scene{.sheet = level_sheet(14, {0.01, side * 0.02, 0.003}, true),
                .mesh = plane_mesh(0.2, 3),
                .time = 0.3};
    scene.mesh.two_sided = true;
    scene.sheet.scene.gravity = {0, -10 * side, 0};
    CHECK(run(scene, Backend::simd) > 0);
  }
}

}  // namespace
}  // namespace weft::test::engine_contact_mesh_crossings
