/// Cloth on bodies of triangles against closed forms and against bodies in closed form; energy,
/// momentum and the bits.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "kernels/reference/distances.h"
#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/isas.h"
#include "tests/support/motion.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_mesh_closed_forms {
namespace {

constexpr double kG = 10;  // m/s^2
constexpr double kDegree = std::numbers::pi / 180;

Settings small_steps(Backend backend) {
  return {.solver = Solver::small_steps, .backend = backend, .threads = 1};
}

/// A square of cotton of 0.5 m in the plane y = height that is then turned about z by the angle.
MeshCloth sheet_at(std::uint32_t size, double height, double angle, bool irregular = false) {
  Random random(2);
  MeshDescription mesh = irregular ? irregular_triangles(size, 0.2, random) : quads(size);
  const double spacing = 0.5 / (size - 1);
  for (Vec3& v : mesh.positions) {
    const Vec3 flat{spacing * v.x - 0.25, height, spacing * v.y - 0.25};
    v = turned(turn({0, 0, 1}, angle), flat);
  }
  mesh.material = find_material("cotton").value();
  return made(mesh);
}

double sum(const std::vector<double>& values) {
  double all = 0;
  for (const double v : values) all += v;
  return all;
}

/// m, down the incline, in the mean, after a time on a triangulated plane of that angle.
double slide(Backend backend, double angle, double friction, double time, bool irregular) {
  SceneDescription scene = sheet_at(9, 1e-3, angle, irregular).scene;
  scene.friction = friction;
  Cloth cloth = cloth_of(scene, small_steps(backend));
  add(cloth, {.shape = shape_of(plane_mesh(8, 43)),
              .pose = {.rotation = turn({0, 0, 1}, angle)},
              .friction = friction});
  const std::vector<Vec3> start = positions(cloth);
  const int steps = static_cast<int>(std::lround(60 * time));
  for (int i = 0; i < steps; ++i) CHECK(step(cloth, 1.0 / 60).intersecting == 0);
  double way = 0;
  for (std::uint32_t i = 0; i < start.size(); ++i) {
    const Vec3 d = cloth.position(i) - start[i];
    way -= d.x * std::cos(angle) + d.y * std::sin(angle);
  }
  return way / static_cast<double>(start.size());
}

TEST_CASE("a sheet on a triangulated incline rests below the angle of friction, and slides above") {
  const Backend backend = each_backend();
  CHECK(std::abs(slide(backend, 16 * kDegree, 0.3, 0.5, true)) < 1e-4);
  const double angle = 25 * kDegree;
  for (const double friction : {0.0, 0.3}) {
    CAPTURE(friction);
    const double a = kG * (std::sin(angle) - friction * std::cos(angle));
    CHECK(slide(backend, angle, friction, 0.5, friction > 0) ==
          doctest::Approx(a / 8).epsilon(0.01));
  }
}

/// m, that the lowest particle is above a plane through the origin that is turned about z.
double height_above(const Cloth& cloth, double angle) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& x : positions(cloth))
    least = std::min(least, x.y * std::cos(angle) - x.x * std::sin(angle));
  return least;
}

TEST_CASE("cloth that begins exactly on a mesh comes to lie on it" * doctest::test_suite("long")) {
  const Backend backend = each_backend();
  constexpr double kThickness = 1e-3;
  for (const double angle : {0.0, 10 * kDegree}) {  // turned, particles are at rounding from it
    for (const std::uint32_t cuts : {3u, 8u}) {     // as fine as the cloth: corner on corner
      for (const bool two_sided : {false, true}) {
        for (const bool is_box : {false, true}) {
          CAPTURE(angle);
          CAPTURE(cuts);
          CAPTURE(two_sided);
          CAPTURE(is_box);
          if (two_sided && angle > 0) continue;  // either side is right there
          Cloth cloth = cloth_of(sheet_at(9, 0, angle).scene, small_steps(backend));
          TriangleMesh mesh = is_box ? box_mesh({0.6, 0.6, 0.6}, cuts) : plane_mesh(0.5, cuts);
          mesh.two_sided = two_sided;
          const double depth = is_box ? 0.3 : 0;
          add(cloth, {.shape = shape_of(mesh),
                      .pose = {.position = {depth * std::sin(angle), -depth * std::cos(angle), 0},
                               .rotation = turn({0, 0, 1}, angle)},
                      .thickness = kThickness,
                      .friction = 1});
          for (int i = 0; i < 20; ++i) {
            const StepReport report = step(cloth, 1.0 / 60);
            CHECK(report.status == Status::converged);
            CHECK(report.intersecting == 0);
          }
          CHECK(height_above(cloth, angle) == doctest::Approx(kThickness).epsilon(0.01));
        }
      }
    }
  }
}

TEST_CASE("without friction a sheet glides over a triangulated plane and keeps its speed") {
  const Backend backend = each_backend();
  SceneDescription scene = sheet_at(9, 1e-3, 0, true).scene;
  scene.velocities.assign(scene.positions.size(), {2, 0, 1});
  scene.air = {};
  Cloth cloth = cloth_of(scene, small_steps(backend));
  add(cloth, {.shape = shape_of(plane_mesh(8, 61)), .friction = 0});
  run(cloth, 1.0 / 60, 60);
  const Vec3 p = momentum(scene.masses, velocities(cloth));
  CHECK(p.x / sum(scene.masses) > 2 * 0.99);
  CHECK(p.z / sum(scene.masses) > 1 * 0.99);
}

TEST_CASE("particles that lie on a triangulated plane lie at its thickness, and weigh on it") {
  const Backend backend = each_backend();
  SceneDescription scene = sheet_at(12, 3e-3, 0).scene;
  scene.surface.clear();
  Cloth cloth = cloth_of(scene, small_steps(backend));
  const auto id = add(cloth, {.shape = shape_of(plane_mesh(2, 23)), .thickness = 2e-3});
  run(cloth, 1.0 / 60, 60);
  const BodyLoad load = cloth.body_load(id).value();
  const double weight = sum(scene.masses) * kG;
  CHECK(load.force.y == doctest::Approx(-weight).epsilon(1e-4));
  CHECK(std::abs(load.force.x) < 1e-4 * weight);
  CHECK(std::abs(load.force.z) < 1e-4 * weight);
  for (const Vec3 x : positions(cloth)) CHECK(std::abs(x.y - 2e-3) < 1e-6);
  for (const Vec3 v : velocities(cloth)) CHECK(length(v) < 1e-6);
  const std::vector<BodyContact> contacts = cloth.body_contacts();
  CHECK(contacts.size() >= scene.positions.size());
  for (const BodyContact& contact : contacts) {
    CHECK(contact.body == id);
    CHECK(contact.normal.y > 0.99);
    CHECK(std::abs(contact.point.y) < 1e-6);
    CHECK(distance(contact.point, cloth.position(contact.particle)) < 2.1e-3);
  }
}

TEST_CASE("a sheet that lies on a triangulated plane weighs on it, and does not wander off") {
  const Backend backend = each_backend();
  const SceneDescription scene = sheet_at(12, 3e-3, 0).scene;
  Cloth cloth = cloth_of(scene, small_steps(backend));
  const auto id = add(cloth, {.shape = shape_of(plane_mesh(2, 23)), .thickness = 2e-3});
  run(cloth, 1.0 / 60, 30);
  double load = 0;
  for (int i = 0; i < 30; ++i) {
    step(cloth, 1.0 / 60);
    load -= cloth.body_load(id).value().force.y / 30;
  }
  CHECK(load == doctest::Approx(sum(scene.masses) * kG).epsilon(0.01));
  for (const Vec3 x : positions(cloth)) {
    CHECK(x.y > 2e-3 - 1e-4);
    CHECK(x.y < 2e-3 + 3e-4);
  }
}

TEST_CASE("a sheet hangs over a ball of triangles as over a ball") {
  const Backend backend = each_backend();
  const TriangleMesh mesh = icosphere(0.12, 4);
  const double flat = 0.12 - inner_radius(mesh);
  const MeshCloth sheet = sheet_at(12, 0.125, 0);
  Cloth on_mesh = cloth_of(sheet.scene, small_steps(backend));
  Cloth on_ball = cloth_of(sheet.scene, small_steps(backend));
  add(on_mesh, {.shape = shape_of(mesh), .friction = 5});
  add(on_ball, {.shape = shape_of(Ball{.radius = 0.12}), .friction = 5});
  run(on_mesh, 1.0 / 60, 60);
  run(on_ball, 1.0 / 60, 60);
  const auto nearest = [&](const Cloth& cloth) {
    const std::vector<Vec3> x = positions(cloth);
    const auto at = [&](std::uint32_t i) { return kernels::Vector{x[i].x, x[i].y, x[i].z}; };
    double least = 1e300;
    for (const auto& [a, b, c] : sheet.scene.surface)
      least = std::min(least, length(reference::nearest_in_triangle({}, at(a), at(b), at(c)).r));
    return least;
  };
  const auto height = [](const Cloth& cloth) {
    double all = 0;
    for (const Vec3 x : positions(cloth)) all += x.y / 144;
    return all;
  };
  // All of the sheet lies on the mesh.
  CHECK(nearest(on_mesh) < 0.121 + 1e-4);
  CHECK(nearest(on_mesh) > 0.121 - flat - 1e-4);
  // Both still swing; 6.3 mm were measured.
  CHECK(std::abs(height(on_mesh) - height(on_ball)) < 8e-3);
  for (const Vec3 x : positions(on_mesh)) CHECK(length(x) > 0.121 - flat - 1e-4);
}

/// A cone of eight sides, 4 cm wide at the height -0.45 m, whose tip is at the origin.
TriangleMesh needle() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, -0.45, 0}};
  for (std::uint32_t i = 0; i < 8; ++i) {
    const double angle = std::numbers::pi / 4 * i;
    mesh.vertices.push_back({0.02 * std::cos(angle), -0.45, 0.02 * std::sin(angle)});
    const std::uint32_t a = 2 + i, b = 2 + (i + 1) % 8;
    mesh.triangles.insert(mesh.triangles.end(), {{0, b, a}, {1, a, b}});
  }
  return mesh;
}

TEST_CASE("coarse cloth stays at its thickness from the tip of a needle, as a tent on its pole") {
  const Backend backend = each_backend();
  for (const std::uint32_t size : {2u, 4u}) {
    for (const double rate : {30.0, 60.0, 240.0}) {
      CAPTURE(size);
      CAPTURE(rate);
      MeshDescription mesh = right_triangles(size);
      for (Vec3& v : mesh.positions) v = {v.x / (size - 1) - 0.47, 0.05, v.y / (size - 1) - 0.48};
      mesh.material = find_material("cotton").value();
      Cloth cloth = cloth_of(made(mesh).scene, small_steps(backend));
      add(cloth, {.shape = shape_of(needle()), .thickness = 1e-3});
      int missed = 0;
      const auto frames = std::lround(1.5 * rate);
      for (long i = 0; i < frames; ++i)
        missed += step(cloth, 1 / rate).status == Status::converged ? 0 : 1;
      CHECK(missed == 0);
    }
  }
}

TEST_CASE("bodies of triangles bring no energy in but by their work") {
  const Backend backend = each_backend();
  for (const bool moves : {false, true}) {
    CAPTURE(moves);
    SceneDescription scene = sheet_at(12, 0.2, 0.2, true).scene;
    scene.friction = 0.5;
    Cloth cloth = cloth_of(scene, small_steps(backend));
    const auto id = add(cloth, {.shape = shape_of(box_mesh({0.2, 0.2, 0.2}, 2)), .friction = 0.5});
    const double start = cloth.energy().total();
    const double unit = sum(scene.masses) * kG * 0.2;
    double work = 0;
    for (int i = 1; i <= 60; ++i) {
      CAPTURE(i);
      if (moves)
        REQUIRE(cloth.move_body(id, {.position = {0, 0.05 * std::sin(i / 5.), 0},
                                     .rotation = turn({0, 1, 0}, 0.05 * i)}));
      const StepReport report = step(cloth, 1.0 / 60);
      work += report.body_work;
      CHECK(report.friction_work >= -1e-9 * unit);
      CHECK(cloth.energy().total() < start + work + 1e-3 * (unit + std::abs(work)));
    }
    if (!moves) CHECK(work == 0);
  }
}

/// Of a sheet that falls on a sphere and slides off, with particles alone or its surface.
std::uint64_t hash_of(const Settings& settings, bool with_surface) {
  SceneDescription scene = sheet_at(40, 0.13, 0.1, true).scene;
  if (!with_surface) scene.surface.clear();
  Cloth cloth = cloth_of(scene, settings);
  const auto id = add(cloth, {.shape = shape_of(icosphere(0.12, 2))});
  add(cloth, {.shape = shape_of(Plane{{0, 1, 0}, -0.1})});
  for (int i = 1; i <= 12; ++i) {
    REQUIRE(cloth.move_body(id, {.position = {0.01 * i, 0.005 * i, 0}}));
    step(cloth, 1.0 / 60);
  }
  CHECK(cloth.body_contacts().size() > 10);
  return cloth.state_hash();
}

TEST_CASE("bits do not depend on threads, nor on AVX2 or AVX-512" * doctest::test_suite("long")) {
  for (const bool with_surface : {true, false}) {
    CAPTURE(with_surface);
    Settings settings = small_steps(Backend::simd);
    const std::uint64_t one = hash_of(settings, with_surface);
    for (const int threads : {2, 4}) {
      CAPTURE(threads);
      settings.threads = threads;
      CHECK(hash_of(settings, with_surface) == one);
    }
    if (!simd::supported(simd::Isa::avx512)) continue;
    settings.threads = 1;
    settings.isa = Isa::avx2;
    const std::uint64_t avx2 = hash_of(settings, with_surface);
    settings.isa = Isa::avx512;
    CHECK(hash_of(settings, with_surface) == avx2);
  }
}

TEST_CASE("both backends move a cloth alike on a body of triangles") {
  const MeshCloth sheet = sheet_at(10, 0.13, 0.05, true);
  Cloth a = cloth_of(sheet.scene, small_steps(Backend::reference));
  Cloth b = cloth_of(sheet.scene, small_steps(Backend::simd));
  for (Cloth* cloth : {&a, &b}) {
    add(*cloth, {.shape = shape_of(icosphere(0.12, 2))});
    run(*cloth, 1.0 / 60, 12);
    CHECK(cloth->body_contacts().size() > 1);
  }
  CHECK(largest_distance(positions(a), positions(b)) < 3e-3);
}

}  // namespace
}  // namespace weft::test::engine_contact_mesh_closed_forms
