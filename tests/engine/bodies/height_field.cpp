/// Terrain: its gap against all triangles, and cloth on it against closed forms, on both backends.
#include <doctest/doctest.h>
#include <weft/body.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "engine/bodies/body_mass.h"
#include "engine/bodies/body_shape.h"
#include "kernels/reference/distances.h"
#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/random.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"
#include "tools/scenes/body_meshes.h"

namespace weft::test::engine_bodies_height_field {
namespace {

using kernels::Vector;

constexpr double kG = 10;  // m/s^2
constexpr int kRates[] = {30, 60, 240};

Settings small_steps(Backend backend) {
  return {.solver = Solver::small_steps, .backend = backend, .threads = 1};
}

/// So many points each way over a square, its middle at the origin of the pose.
template <class Height>
HeightField terrain(std::uint32_t points, double width, Height&& height) {
  const double spacing = width / (points - 1);
  HeightField field{points, points, spacing, spacing, {}};
  for (std::uint32_t row = 0; row < points; ++row) {
    for (std::uint32_t column = 0; column < points; ++column)
      field.heights.push_back(height(column * spacing - width / 2, row * spacing - width / 2));
  }
  return field;
}
Pose centred(double width) { return {.position = {-width / 2, 0, -width / 2}}; }

// -------------------------------------------------------------------------------------- the gap

Vector inside(Vec3 v) { return {v.x, v.y, v.z}; }

/// m, from the surface by all triangles, and from the sides by many places along them.
double distance_by_all(const HeightField& field, Vector y) {
  const TriangleMesh mesh = scenes::terrain_mesh(field);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto nearest = reference::nearest_in_triangle(
        y, inside(mesh.vertices[a]), inside(mesh.vertices[b]), inside(mesh.vertices[c]));
    least = std::min(least, length(nearest.r));
  }
  const auto see_side = [&](Vec3 a, Vec3 b) {
    constexpr int kPlaces = 400;
    for (int i = 0; i <= kPlaces; ++i) {
      const double share = static_cast<double>(i) / kPlaces;
      const Vec3 top = a + share * (b - a);
      least = std::min(least, std::hypot(y.x - top.x, y.z - top.z, std::max(0.0, y.y - top.y)));
    }
  };
  const auto at = [&](std::uint32_t column, std::uint32_t row) {
    return mesh.vertices[row * field.columns + column];
  };
  for (std::uint32_t i = 0; i + 1 < field.columns; ++i) {
    for (const std::uint32_t row : {0u, field.rows - 1}) see_side(at(i, row), at(i + 1, row));
  }
  for (std::uint32_t i = 0; i + 1 < field.rows; ++i) {
    for (const std::uint32_t column : {0u, field.columns - 1})
      see_side(at(column, i), at(column, i + 1));
  }
  return least;
}

TEST_CASE("the gap of terrain is the distance from its triangles and its sides") {
  Random random(5);
  int above = 0, below = 0;
  for (int trial = 0; trial < 12; ++trial) {
    HeightField field{2 + random.below(9), 2 + random.below(6), 0.1, 0.15, {}};
    for (std::uint32_t i = 0; i < field.columns * field.rows; ++i)
      field.heights.push_back(random.between(-0.3, 0.3));
    const auto shape = shape_of(field);
    for (int i = 0; i < 150; ++i) {
      CAPTURE(trial);
      CAPTURE(i);
      const double beside = i % 3 == 0 ? 1 : 0;
      const double width = 0.1 * (field.columns - 1), depth = 0.15 * (field.rows - 1);
      const Vector y{random.between(-beside, width + beside), random.between(-0.6, 0.6),
                     random.between(-beside, depth + beside)};
      const reference::Gap gap = shape->form()->gap(y);
      CHECK(std::abs(gap.gap) == doctest::Approx(distance_by_all(field, y)).epsilon(1e-4));
      CHECK(length(gap.normal) == doctest::Approx(1).epsilon(1e-9));
      const Vector toward = y - gap.gap * gap.normal;  // on the surface
      CHECK(std::abs(shape->form()->gap(toward).gap) < 1e-9);
      (gap.gap > 0 ? above : below) += 1;
    }
  }
  CHECK(above > 500);
  CHECK(below > 300);
}

TEST_CASE("the gap of terrain is that of a plane on its slopes, also at no distance") {
  const double slope = std::tan(0.6);
  const auto shape = shape_of(terrain(9, 2, [&](double x, double z) { return slope * x - z / 3; }));
  const Vector across{-slope, 1, 1. / 3};
  const Vector normal = (1 / length(across)) * across;
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const double x = random.between(0.7, 1.3), z = random.between(0.7, 1.3);
    const Vector foot{x, slope * (x - 1) - (z - 1) / 3, z};
    const double height = i % 3 == 0 ? 0 : random.between(-0.1, 0.1);
    const reference::Gap gap = shape->form()->gap(foot + height * normal);
    CHECK(std::abs(gap.gap - height) < 1e-12);
    CHECK(length(gap.normal - normal) < 1e-6);
  }
}

TEST_CASE("shapes of terrain that are none are refused") {
  const auto refusal = [](const HeightField& field) { return build_shape(field).error(); };
  const HeightField good{2, 2, 1, 1, {0, 0, 0, 0}};
  REQUIRE(build_shape(good));
  HeightField field = good;
  field.columns = 1;
  CHECK(refusal(field) == "columns: must be 2 or more (1)");
  field = good;
  field.rows = 3;
  CHECK(refusal(field) == "heights: must be columns times rows, 6 (4)");
  field = good;
  field.spacing_z = 0;
  CHECK(refusal(field) == "spacing_z: must be finite and greater than 0 (0)");
  field = good;
  field.heights[2] = NAN;
  CHECK(refusal(field) == "heights[2]: must be finite (nan)");
  CHECK(mass_of(*shape_of(good), 1).error() ==
        "shape: has a mass as " + shapes_with_mass() + " alone (a height field)");
}

// ------------------------------------------------------------------------------------- cloth on it

/// In the plane through the origin that is turned about z by the angle.
SceneDescription sheet(std::uint32_t size, double angle, double height, double width = 0.5) {
  MeshDescription mesh = quads(size);
  const double spacing = width / (size - 1);
  for (Vec3& v : mesh.positions) {
    const double along = spacing * v.x - width / 2, across = spacing * v.y - width / 2;
    v = {std::cos(angle) * along - std::sin(angle) * height,
         std::sin(angle) * along + std::cos(angle) * height, across};
  }
  mesh.material = find_material("cotton").value();
  SceneDescription scene = made(mesh).scene;
  scene.air.density = 0;
  return scene;
}

double mass_of(const SceneDescription& scene) {
  return std::accumulate(scene.masses.begin(), scene.masses.end(), 0.0);
}

struct Incline {
  double angle, friction;
  Backend backend;
  int rate;
};

/// m, by which a sheet comes down in a second along terrain that is steep, and by which it leaves
/// the plane.
std::pair<double, double> slide(const Incline& incline) {
  SceneDescription scene = sheet(9, incline.angle, 1e-3);
  scene.friction = incline.friction;
  Cloth cloth = cloth_of(scene, small_steps(incline.backend));
  const double slope = std::tan(incline.angle), width = 12;
  add(cloth, {.shape = shape_of(terrain(101, width, [&](double x, double) { return slope * x; })),
              .pose = centred(width),
              .friction = incline.friction});
  const std::vector<Vec3> start = positions(cloth);
  for (int i = 0; i < incline.rate; ++i) {
    const StepReport report = step(cloth, 1.0 / incline.rate);
    CHECK(report.status == Status::converged);
    CHECK(report.max_penetration < 1e-5);
  }
  double along = 0, aside = 0;
  for (std::uint32_t i = 0; i < start.size(); ++i) {
    const Vec3 by = cloth.position(i) - start[i];
    along -= (by.x * std::cos(incline.angle) + by.y * std::sin(incline.angle)) /
             static_cast<double>(start.size());
    aside =
        std::max(aside, std::abs(by.y * std::cos(incline.angle) - by.x * std::sin(incline.angle)));
  }
  return {along, aside};
}

TEST_CASE("a sheet on terrain rests below the angle of friction, and slides by its law above") {
  const Backend backend = each_backend();
  constexpr double kDegree = std::numbers::pi / 180;
  for (const int rate : kRates) {
    CAPTURE(rate);
    const auto [creeps, leaves] = slide({16 * kDegree, 0.3, backend, rate});
    CHECK(std::abs(creeps) < 1e-4);
    CHECK(leaves < 1e-5);
    const double angle = 25 * kDegree;
    for (const double friction : {0.0, 0.3}) {
      CAPTURE(friction);
      const double a = kG * (std::sin(angle) - friction * std::cos(angle));
      const auto [slides, off] = slide({angle, friction, backend, rate});
      CHECK(slides == doctest::Approx(a / 2).epsilon(0.01));
      CHECK(off < 1e-5);
    }
  }
}

/// Where a sheet is that falls onto a shape, after so many seconds.
std::vector<Vec3> fallen(const SceneDescription& scene, const Body& body, Backend backend, int rate,
                         double seconds) {
  Cloth cloth = cloth_of(scene, small_steps(backend));
  add(cloth, body);
  run(cloth, 1.0 / rate, static_cast<int>(seconds * rate));
  return positions(cloth);
}

TEST_CASE("flat terrain is a plane") {
  const Backend backend = each_backend();
  const SceneDescription scene = sheet(8, 0.2, 0.06);
  const auto flat = shape_of(terrain(17, 3, [](double, double) { return 0.02; }));
  const auto plane = shape_of(Plane{{0, 1, 0}, 0.02});
  for (const int rate : kRates) {
    CAPTURE(rate);
    CHECK(largest_distance(fallen(scene, {.shape = flat, .pose = centred(3)}, backend, rate, 0.25),
                           fallen(scene, {.shape = plane}, backend, rate, 0.25)) < 1e-4);
  }
}

/// A ball of 0.4 m whose top is at 0.
constexpr double kRadius = 0.4, kSampled = 0.7;  // m, and so wide a part of it
const Vec3 kCentre{0, -kRadius, 0};
constexpr std::uint32_t kSamples = 141;
/// A side of a triangle is under the ball by its square over 8 r, that of a cell upright, and on
/// slopes of up to 45 degrees twice as long.
constexpr double kSampling =
    2 * (kSampled / (kSamples - 1)) * (kSampled / (kSamples - 1)) * 2 / (8 * kRadius);

Body sampled_ball() {
  const auto height = [](double x, double z) {
    return std::sqrt(std::max(0.0, kRadius * kRadius - x * x - z * z)) - kRadius;
  };
  return {.shape = shape_of(terrain(kSamples, kSampled, height)),
          .pose = centred(kSampled),
          .friction = 10};
}

TEST_CASE("terrain that samples a ball is that ball within its sampling") {
  const Backend backend = each_backend();
  SceneDescription beads;
  Random random(7);
  for (int i = 0; i < 60; ++i) {
    const Vec3 x = random.in_box(0.15);
    beads.positions.push_back({x.x, 2e-3, x.z});
    beads.masses.push_back(0.01);
  }
  beads.friction = 10;
  const Body field = sampled_ball();
  const Body ball{.shape = shape_of(Ball{kCentre, kRadius}), .friction = 10};
  const SceneDescription cloth = sheet(12, 0, 2e-3, 0.3);
  for (const int rate : kRates) {
    CAPTURE(rate);
    const auto on_field = fallen(beads, field, backend, rate, 0.5);
    CHECK(largest_distance(on_field, fallen(beads, ball, backend, rate, 0.5)) < 3e-4);
    for (const Vec3 x : fallen(cloth, field, backend, rate, 1.5))
      CHECK(distance(x, kCentre) > kRadius + 1e-3 - kSampling - 2e-5);
  }
}

double bumps(double x, double z) { return 0.03 * std::sin(9 * x) * std::cos(8 * z); }

TEST_CASE("terrain bears the weight of what lies on it, at rest") {
  const Backend backend = each_backend();
  SceneDescription scene = sheet(14, 0, 0.05);
  for (const int rate : kRates) {
    CAPTURE(rate);
    Cloth cloth = cloth_of(scene, small_steps(backend));
    const auto id = add(cloth, {.shape = shape_of(terrain(61, 1.5, bumps)), .pose = centred(1.5)});
    run(cloth, 1.0 / rate, 4 * rate);
    const std::vector<Vec3> before = positions(cloth);
    double force = 0;
    for (int i = 0; i < rate / 5; ++i) {
      const StepReport report = step(cloth, 1.0 / rate);
      CHECK(report.status == Status::converged);
      CHECK(report.max_penetration < 1e-5);
      force += cloth.body_load(id).value().force.y / (rate / 5);
    }
    CHECK(force == doctest::Approx(-mass_of(scene) * kG).epsilon(0.01));
    CHECK(largest_distance(positions(cloth), before) < 1e-4);
  }
}

TEST_CASE("terrain that moves and turns takes what lies on it along") {
  const Backend backend = each_backend();
  SceneDescription scene = sheet(8, 0, 1e-3);
  scene.friction = 10;
  for (const int rate : kRates) {
    CAPTURE(rate);
    Cloth cloth = cloth_of(scene, small_steps(backend));
    const auto flat = shape_of(terrain(21, 4, [](double, double) { return 0.0; }));
    const auto pose_at = [&](double t) {  // about the middle of the sheet, and away from it
      const double angle = 0.5 * t * t;
      const Rotation turned_by = turn({0, 1, 0}, angle);
      return Pose{turned(turned_by, {-2, 0, -2}) + Vec3{t * t, 0.1 * t, 0}, turned_by};
    };
    const auto id = add(cloth, {.shape = flat, .pose = pose_at(0), .friction = 10});
    for (int i = 1; i <= rate; ++i) {
      REQUIRE(cloth.move_body(id, pose_at(static_cast<double>(i) / rate)));
      CHECK(step(cloth, 1.0 / rate).max_penetration < 1e-4);
    }
    const Rotation turned_by = turn({0, 1, 0}, 0.5);
    for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
      const Vec3 expected = turned(turned_by, scene.positions[i]) + Vec3{1, 0.1, 0};
      CHECK(distance(cloth.position(i), expected) < 0.02);
    }
  }
}

/// Beads over a slope that leads to the left of the origin, or on the ground there.
SceneDescription beads(double slope, Vec3 velocity) {
  SceneDescription scene;
  for (int i = 0; i < 5; ++i) {
    scene.positions.push_back({-0.3, 0.3 * slope + (i == 0 ? 1e-3 : 0.05 + 0.05 * i), 0.03 * i});
    scene.masses.push_back(0.01);
    scene.velocities.push_back(velocity);
  }
  return scene;
}

TEST_CASE("particles do not pass through a narrow ridge, whether they fly or slide toward it") {
  const Backend backend = each_backend();
  const auto ridge = [](double x, double) { return std::abs(x) < 0.01 ? 0.5 : 0.0; };
  for (const int rate : kRates) {
    CAPTURE(rate);
    Cloth cloth = cloth_of(beads(0, {20, 0, 0}), small_steps(backend));
    add(cloth, {.shape = shape_of(terrain(51, 2, ridge)), .pose = centred(2), .friction = 0});
    run(cloth, 1.0 / rate, rate / 5);
    for (const Vec3 x : positions(cloth)) CHECK(x.x < 0);
  }
}

TEST_CASE("particles that fall into a valley lie at its bottom, however steep its sides are") {
  const Backend backend = each_backend();
  for (const double slope : {0.5, 1.5, 6.0}) {
    for (const int rate : kRates) {
      CAPTURE(slope);
      CAPTURE(rate);
      SceneDescription scene = beads(slope, {});
      for (Vec3& x : scene.positions) x.y += 0.05;
      Cloth cloth = cloth_of(scene, small_steps(backend));
      const auto valley = [&](double x, double) { return slope * std::abs(x); };
      add(cloth, {.shape = shape_of(terrain(41, 2, valley)), .pose = centred(2), .friction = 0.3});
      for (int i = 0; i < 4 * rate; ++i) {
        const StepReport report = step(cloth, 1.0 / rate);
        CHECK(report.status == Status::converged);
        CHECK(report.max_penetration < 1e-5);
      }
      // Both sides are at the thickness.
      for (const Vec3 x : positions(cloth)) {
        CHECK(std::abs(x.x) < 1e-5);
        CHECK(x.y == doctest::Approx(1e-3 * std::sqrt(1 + slope * slope)).epsilon(0.01));
      }
    }
  }
}

/// m, by which a bead comes down in a second along a groove whose sides are as steep as 45 degrees.
double slide_in_groove(double angle, double friction, Backend backend, int rate) {
  const auto groove = [](double x, double) { return std::abs(x); };
  const Rotation tilt = turn({1, 0, 0}, angle);  // along z it goes down
  SceneDescription scene;
  scene.positions = {turned(tilt, {0, std::sqrt(2.0) * 1e-3, 0})};
  scene.masses = {0.01};
  scene.friction = friction;
  Cloth cloth = cloth_of(scene, small_steps(backend));
  const Pose pose{turned(tilt, {-2, 0, -2}), tilt};
  add(cloth, {.shape = shape_of(terrain(41, 4, groove)), .pose = pose, .friction = friction});
  for (int i = 0; i < rate; ++i) {
    const StepReport report = step(cloth, 1.0 / rate);
    CHECK(report.status == Status::converged);
    CHECK(report.max_penetration < 1e-5);
  }
  return distance(cloth.position(0), scene.positions[0]);
}

/// Each side bears 1 / sqrt(2) of what the ground of a slope bears.
TEST_CASE("friction in a groove has the forces of both of its sides") {
  const Backend backend = each_backend();
  constexpr double kDegree = std::numbers::pi / 180, kFriction = 0.3;
  for (const int rate : kRates) {
    CAPTURE(rate);
    // On a slope it would slide from 16.7 degrees on.
    CHECK(slide_in_groove(22 * kDegree, kFriction, backend, rate) < 1e-4);
    const double angle = 35 * kDegree;
    const double a = kG * (std::sin(angle) - kFriction * std::sqrt(2.0) * std::cos(angle));
    CHECK(slide_in_groove(angle, kFriction, backend, rate) == doctest::Approx(a / 2).epsilon(0.01));
    CHECK(slide_in_groove(angle, 0, backend, rate) ==
          doctest::Approx(kG * std::sin(angle) / 2).epsilon(0.01));
  }
}

}  // namespace
}  // namespace weft::test::engine_bodies_height_field
