/// Cloth between two bodies that leave less room than both their thicknesses.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_narrow_gaps {
namespace {

constexpr double kThickness = 1e-3;  // m, of each body
constexpr Vec3 kTable{0.3, 0.1, 0.3}, kPlate{0.2, 0.1, 0.2};
constexpr double kBall = 0.1;  // m, its radius

ShapeDescription shape(Vec3 size, bool is_mesh) {
  if (is_mesh) return box_mesh(size, 4);
  return box(size);
}

struct Press {
  bool table_is_mesh = false, plate_is_mesh = false;
  bool by_ball = false;  // in place of a plate
  double room = 0;       // m, between both in the end
  double friction = 0;   // of all
  double rate = 60;      // Hz
  Backend backend = Backend::simd;
};

ShapeDescription pressing(const Press& by) {
  if (!by.by_ball) return shape(kPlate, by.plate_is_mesh);
  if (by.plate_is_mesh) return icosphere(kBall, 2);
  return Ball{.radius = kBall};
}

struct Held {
  double fastest = 0;              // m/s, once the plate stands
  double highest = 0, lowest = 1;  // m, over the table, under the middle of the plate
  int missed = 0;                  // frames, likewise
  double friction = 0, work = 0;   // J, of all frames: what it took, and what bodies put in
};

/// A sheet of cotton lies on a table. A plate comes down on it within a quarter of a second, and
/// stands for half a second.
Held press(const Press& by) {
  MeshDescription mesh = quads(13);
  for (Vec3& v : mesh.positions)
    v = {(v.x - 6) * 0.26 / 12, kTable.y / 2 + kThickness, (v.y - 6) * 0.26 / 12};
  mesh.material = find_material("cotton").value();
  SceneDescription scene = made(mesh).scene;
  scene.friction = by.friction;
  Cloth cloth =
      cloth_of(scene, {.solver = Solver::small_steps, .backend = by.backend, .threads = 1});
  add(cloth, {.shape = shape_of(shape(kTable, by.table_is_mesh)),
              .thickness = kThickness,
              .friction = by.friction});
  const double reach = by.by_ball ? kBall : kPlate.y / 2;  // m, below its middle
  const auto pose = [&](double room) {
    return Pose{.position = {0, kTable.y / 2 + reach + room, 0}};
  };
  const double from = 0.05;
  const std::uint32_t plate = add(cloth, {.shape = shape_of(pressing(by)),
                                          .pose = pose(from),
                                          .thickness = kThickness,
                                          .friction = by.friction});
  Held held;
  const auto frames = std::lround(0.75 * by.rate);
  for (long i = 1; i <= frames; ++i) {
    const double time = static_cast<double>(i) / by.rate, left = std::max(0.0, 1 - 4 * time);
    REQUIRE(cloth.move_body(plate, pose(by.room + left * (from - by.room))));
    const StepReport report = step(cloth, 1 / by.rate);
    held.friction += report.friction_work;
    held.work += std::max(0.0, report.body_work);
    if (time < 0.5) continue;
    for (const Vec3 v : velocities(cloth)) held.fastest = std::max(held.fastest, length(v));
    held.missed += report.status == Status::converged ? 0 : 1;
  }
  for (const Vec3 x : positions(cloth)) {
    if (std::max(std::abs(x.x), std::abs(x.z)) > 0.08) continue;
    held.highest = std::max(held.highest, x.y - kTable.y / 2);
    held.lowest = std::min(held.lowest, x.y - kTable.y / 2);
  }
  return held;
}

void check_held(const Press& by) {
  CAPTURE(by.table_is_mesh);
  CAPTURE(by.plate_is_mesh);
  CAPTURE(by.room);
  CAPTURE(by.rate);
  const Held held = press(by);
  CHECK(held.missed == 0);
  CHECK(held.fastest < 0.05);
  CHECK(held.friction <= held.work + 1e-6);
  CHECK(std::abs(held.lowest - by.room / 2) < 5e-5);
  CHECK(std::abs(held.highest - by.room / 2) < 5e-5);
}

TEST_CASE("two bodies share the room between them, and what they hold rests" *
          doctest::test_suite("long")) {
  for (const double rate : {30.0, 60.0, 240.0}) {
    for (const double room : {1.5e-3, 5e-4}) {
      check_held({.room = room, .friction = 0.3, .rate = rate});
      check_held({.plate_is_mesh = true, .room = room, .friction = 0.3, .rate = rate});
      check_held({.table_is_mesh = true, .room = room, .friction = 0.3, .rate = rate});
    }
    check_held({.table_is_mesh = true,
                .plate_is_mesh = true,
                .room = 1.5e-3,
                .friction = 0.3,
                .rate = rate});
  }
}

TEST_CASE("two bodies share the room between them in frames of a single substep, too") {
  check_held({.table_is_mesh = true, .room = 1.5e-3, .friction = 0.3, .rate = 1000});
}

TEST_CASE("cloth that a ball presses into a table is not torn to and fro, nor said to be held" *
          doctest::test_suite("long")) {
  for (const double rate : {30.0, 60.0, 240.0}) {
    CAPTURE(rate);
    const Held held = press({.table_is_mesh = true,
                             .plate_is_mesh = true,
                             .by_ball = true,
                             .room = -0.02,
                             .friction = 0.3,
                             .rate = rate});
    CHECK(held.missed == std::lround(rate / 4) + 1);
    CHECK(held.fastest < 0.2);  // 0.13 at 60 Hz, below 0.05 at the others
    CHECK(held.friction <= held.work);
  }
}

TEST_CASE("friction takes no more than was put in where closed forms overlap, and cloth is held" *
          doctest::test_suite("long")) {
  for (const double rate : {30.0, 60.0, 240.0}) {
    for (const bool by_ball : {false, true}) {
      CAPTURE(rate);
      CAPTURE(by_ball);
      const Held held = press({.by_ball = by_ball, .room = -0.02, .friction = 0.3, .rate = rate});
      CHECK(held.missed == std::lround(rate / 4) + 1);
      CHECK(held.fastest < 0.3);
      CHECK(held.friction <= held.work);
      const Held deeper = press({.by_ball = by_ball, .room = -0.04, .friction = 0.3, .rate = rate});
      CHECK(deeper.fastest < 1);
      CHECK(deeper.friction <= deeper.work);
    }
  }
}

void check_presses_deep(double rate) {
  CAPTURE(rate);
  for (const bool table_is_mesh : {false, true}) {
    for (const bool ball_is_mesh : {false, true}) {
      for (const double room : {-0.04, -0.06}) {
        CAPTURE(table_is_mesh);
        CAPTURE(ball_is_mesh);
        CAPTURE(room);
        const Held held = press({.table_is_mesh = table_is_mesh,
                                 .plate_is_mesh = ball_is_mesh,
                                 .by_ball = true,
                                 .room = room,
                                 .friction = 0.3,
                                 .rate = rate});
        CHECK(held.fastest < 1);
        CHECK(held.friction <= held.work);
      }
    }
  }
}

TEST_CASE("cloth that a ball presses deep into a body is not thrown about where both meet" *
          doctest::test_suite("long")) {
  check_presses_deep(60);
}

TEST_CASE("cloth that a ball presses deep into a body is not thrown about at other frame rates" *
          doctest::test_suite("slow")) {
  check_presses_deep(30);
  check_presses_deep(240);
}

TEST_CASE("two bodies share the room in double, too, and without friction") {
  check_held({.room = 1e-3, .friction = 0.3, .backend = Backend::reference});
  check_held({.room = 1e-3, .friction = 0});
  check_held({.table_is_mesh = true, .plate_is_mesh = true, .room = 1.5e-3, .friction = 0});
}

/// A square whose middle is 2 mm inside of a hull, since it hangs over the ridge between particles.
/// A plate of triangles is 4.2 mm above it, where hull and plate leave each particle what both ask
/// for.
TEST_CASE("a hull that comes through the cloth between particles leaves them no nearer to it") {
  constexpr double kHalf = 0.02, kSlope = 0.15, kHull = 1e-3, kAbove = 4e-3;
  const double height = kHull * std::hypot(1, kSlope) - kSlope * kHalf;
  const double plate_size = 0.01, apart = 4.2e-3;
  SceneDescription scene;
  for (const double x : {-kHalf, kHalf}) {
    for (const double z : {-kHalf, kHalf}) scene.positions.push_back({x, height, z});
  }
  scene.masses.assign(4, 1e-3);
  scene.constraints = {{0, 1, 2 * kHalf}, {1, 3, 2 * kHalf}, {3, 2, 2 * kHalf}, {2, 0, 2 * kHalf}};
  scene.surface = {{0, 1, 3}, {0, 3, 2}};
  scene.friction = 1;
  for (const Backend backend : {Backend::simd, Backend::reference}) {
    CAPTURE(backend);
    Cloth cloth =
        cloth_of(scene, {.solver = Solver::small_steps, .backend = backend, .threads = 1});
    Hull ridge;
    for (const double z : {-0.1, 0.1}) {
      for (const Vec3& v : {Vec3{-0.1, -0.1 * kSlope, z}, Vec3{0, 0, z},
                            Vec3{0.1, -0.1 * kSlope, z}, Vec3{0, -0.1, z}})
        ridge.points.push_back(v);
    }
    add(cloth, {.shape = shape_of(ridge), .thickness = kHull, .friction = 1});
    add(cloth, {.shape = shape_of(box_mesh({0.2, plate_size, 0.2}, 4)),
                .pose = {.position = {0, height + apart + plate_size / 2, 0}},
                .thickness = kAbove});
    for (int frame = 0; frame < 30; ++frame) {
      CHECK(step(cloth, 1.0 / 60).status == Status::converged);
      for (const Vec3& x : positions(cloth)) {
        const double gap = (x.y + kSlope * std::abs(x.x)) / std::hypot(1, kSlope);
        CHECK(gap > kHull - 2e-6);
      }
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_contact_narrow_gaps
