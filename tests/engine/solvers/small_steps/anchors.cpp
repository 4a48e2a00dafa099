/// Anchors against closed forms, on both backends.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/anchored.h"
#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_small_steps_anchors {
namespace {

using namespace anchored;

Anchor plane(Vec3 point, Vec3 normal) {
  return {
      .point = point, .normal = normal, .max_distance = kInfinity, .backstop_radius = kInfinity};
}

/// m, from where a pendulum is after half a period.
double pendulum_error(Backend backend, int substeps) {
  const double angle = 1.2, end = pendulum_period(angle) / 2;
  const Vec3 start{std::sin(angle), -std::cos(angle), 0};
  Cloth cloth =
      cloth_of(one_particle(start, {}, {.max_distance = 1}), small_steps(backend, substeps));
  run(cloth, end / 50, 50);
  return distance(cloth.position(0), {-start.x, start.y, 0});
}

TEST_CASE("what hangs on a maximum distance swings as a pendulum, to second order") {
  for (const Backend backend : kBackends) {
    const double coarse = pendulum_error(backend, 2), middle = pendulum_error(backend, 4),
                 fine = pendulum_error(backend, 8);
    CAPTURE(coarse);
    CAPTURE(middle);
    CAPTURE(fine);
    CHECK(coarse < 0.01);
    CHECK(coarse / middle > 3.4);
    CHECK(middle / fine > 3.4);
  }
}

TEST_CASE("with a maximum distance of 0 a particle is where its point is, at its speed") {
  for (const Backend backend : kBackends) {
    for (const int substeps : {1, 7}) {
      Cloth cloth = cloth_of(one_particle({1, 0, 0}, {}, {.point = {1, 0, 0}}),
                             small_steps(backend, substeps));
      Vec3 before{1, 0, 0};
      for (int frame = 1; frame <= 50; ++frame) {
        const Vec3 point{std::cos(0.1 * frame), std::sin(0.1 * frame), 0};
        REQUIRE(cloth.move_anchors({&point, 1}));
        const StepReport report = step(cloth, 0.01);
        CHECK(report.status == Status::converged);
        CHECK(report.max_anchor_error < 1e-7);
        CHECK(distance(cloth.position(0), point) < 1e-7);
        CHECK(distance(cloth.velocity(0), 100 * (point - before)) < 1e-4);
        before = point;
      }
    }
  }
}

TEST_CASE("a maximum distance that becomes taut is a rope: it takes the speed along it alone") {
  for (const Backend backend : kBackends) {
    // From 0.6 m aside it meets the circle of 1 m with a cosine of 0.8.
    SceneDescription scene = one_particle({0, 0.6, 0}, {2, 0, 0}, {.max_distance = 1});
    scene.gravity = {0, 0, 0};
    Cloth cloth = cloth_of(scene, small_steps(backend, 20));
    run(cloth, 0.01, 100);
    const Vec3 x = cloth.position(0), v = cloth.velocity(0);
    CHECK(length(x) == doctest::Approx(1).epsilon(1e-6));
    CHECK(length(v) == doctest::Approx(2 * 0.6).epsilon(2e-3));
    CHECK(std::abs(dot(x, v)) < 1e-3);
    const double angle = std::atan2(0.6, 0.8) - 1.2 * (1 - 0.8 / 2);
    CHECK(std::atan2(x.y, x.x) == doctest::Approx(angle).epsilon(5e-3));
  }
}

TEST_CASE("what a point pulls along comes to move as it does, and does not bounce") {
  for (const Backend backend : kBackends) {
    SceneDescription scene = one_particle({0, 0, 0}, {}, {.max_distance = 0.1});
    scene.gravity = {0, 0, 0};
    Cloth cloth = cloth_of(scene, small_steps(backend, 10));
    double speed = 0;
    Vec3 point;
    for (int frame = 0; frame < 100; ++frame) {
      if (frame < 40) speed += 0.05;
      point.x += 0.01 * speed;
      REQUIRE(cloth.move_anchors({&point, 1}));
      step(cloth, 0.01);
      if (point.x < 0.12) continue;
      CAPTURE(frame);
      CHECK(cloth.velocity(0).x == doctest::Approx(speed).epsilon(1e-3));
      CHECK(point.x - cloth.position(0).x == doctest::Approx(0.1).epsilon(1e-3));
    }
  }
}

TEST_CASE(
    "on a plane behind it a particle slides as without friction, and rests where it is level") {
  for (const Backend backend : kBackends) {
    const double angle = 0.5;
    const Vec3 normal{std::sin(angle), std::cos(angle), 0},
        down{std::cos(angle), -std::sin(angle), 0};
    Cloth slope = cloth_of(one_particle({}, {}, plane({}, normal)), small_steps(backend, 10));
    run(slope, 0.01, 50);
    CHECK(distance(slope.position(0), 0.5 * 10 * std::sin(angle) * 0.25 * down) < 1e-3);
    CHECK(distance(slope.velocity(0), 10 * std::sin(angle) * 0.5 * down) < 1e-3);
    Cloth floor =
        cloth_of(one_particle({0, 0.3, 0}, {}, plane({}, {0, 1, 0})), small_steps(backend, 10));
    for (int frame = 0; frame < 60; ++frame) {
      const StepReport report = step(floor, 0.01);
      CHECK(report.max_anchor_error <= 1e-4);
      CHECK(floor.position(0).y > -1e-6);
    }
    CHECK(std::abs(floor.position(0).y) < 1e-6);
    CHECK(length(floor.velocity(0)) < 1e-6);
  }
}

TEST_CASE("a particle slides down a backstop as fast as its fall says") {
  for (const Backend backend : kBackends) {
    const double angle = 0.2;
    Anchor anchor = plane({0, 1, 0}, {0, 1, 0});
    anchor.backstop_radius = 1;
    Cloth cloth = cloth_of(one_particle({std::sin(angle), std::cos(angle), 0}, {}, anchor),
                           small_steps(backend, 16));
    run(cloth, 0.01, 60);
    const Vec3 x = cloth.position(0);
    CHECK(length(x) == doctest::Approx(1).epsilon(1e-6));
    CHECK(length(cloth.velocity(0)) ==
          doctest::Approx(std::sqrt(20 * (std::cos(angle) - x.y))).epsilon(2e-3));
  }
}

/// The lowest places that its anchor leaves a bead: the rim where a ball of 10 cm around its point
/// meets a backstop of 5 cm, 2 cm below that point.
struct Rim {
  Anchor anchor{
      .normal = {0, 1, 0}, .max_distance = 0.1, .backstop_distance = 0.02, .backstop_radius = 0.05};
  double height = (0.05 * 0.05 - 0.1 * 0.1 - 0.07 * 0.07) / 0.14;
  double radius = std::sqrt(0.1 * 0.1 - height * height);
};

// With one limit after the other a bead that rests had 0.02 m/s, and cloth in air circled for ever.
TEST_CASE(
    "a bead between both limits runs along their rim as its decay says, and rests in the end") {
  const Rim rim;
  const double speed = 0.2, decay = 0.3;
  for (const Backend backend : kBackends) {
    for (const int substeps : {1, 4, 16}) {
      CAPTURE(substeps);
      SceneDescription scene = one_particle({rim.radius, rim.height, 0}, {0, 0, speed}, rim.anchor);
      scene.damping.motion = decay;
      Cloth cloth = cloth_of(scene, small_steps(backend, substeps));
      for (int second = 1; second <= 30; ++second) {
        run(cloth, 1. / 60, 60);
        const Vec3 x = cloth.position(0);
        CHECK(length(cloth.velocity(0)) ==
              doctest::Approx(speed * std::exp(-decay * second)).epsilon(0.02));
        CHECK(x.y == doctest::Approx(rim.height).epsilon(1e-5));
      }
      run(cloth, 1. / 60, 3000);
      CHECK(length(cloth.velocity(0)) < 1e-5);
    }
  }
}

TEST_CASE("cloth in air that hangs on four rims comes to rest") {
  const Rim rim;
  MeshDescription mesh;
  mesh.positions = {{0, 0, 0}, {0.05, 0, 0}, {0.05, 0, 0.05}, {0, 0, 0.05}};
  mesh.corners = {0, 1, 2, 0, 2, 3};
  mesh.face_sizes = {3, 3};
  mesh.material = find_material("cotton").value();
  SceneDescription scene = cloth_from_mesh(mesh).value().scene;
  scene.damping.motion = 0.3;
  for (std::uint32_t i = 0; i < 4; ++i) {
    Anchor anchor = rim.anchor;
    anchor.particle = i;
    anchor.point = scene.positions[i];
    scene.anchors.push_back(anchor);
    scene.positions[i] = scene.positions[i] + Vec3{rim.radius, rim.height, 0};
  }
  scene.velocities.assign(4, {0, 0, 0.2});
  for (const Backend backend : kBackends) {
    Cloth cloth = cloth_of(scene, small_steps(backend));
    run(cloth, 1. / 60, 60 * 60);
    for (const Vec3& v : velocities(cloth)) CHECK(length(v) < 1e-3);
  }
}

/// A body that walks along x at 1.5 m/s, sways, and turns about y.
std::vector<Vec3> walking(const std::vector<Vec3>& shape, double t) {
  std::vector<Vec3> points;
  const double angle = 1.5 * std::sin(2 * t), c = std::cos(angle), s = std::sin(angle);
  for (const Vec3 p : shape) {
    const double swing = 0.1 * (1 - p.y) * std::sin(9 * t);
    points.push_back({c * p.x + s * p.z + 1.5 * t, p.y + 0.03 * std::abs(std::sin(9 * t)),
                      c * p.z - s * p.x + swing});
  }
  return points;
}

TEST_CASE("a cape whose particles are to stay within 5 cm of a body that walks and turns does") {
  for (const char* name : {"hang", "cape"}) {
    for (const Backend backend : kBackends) {
      SceneDescription scene = scene_of(name, 15);
      scene.fixed.clear();
      anchor_all(scene, 0.05);
      const std::vector<Vec3> shape = points_of(scene);
      Cloth cloth = cloth_of(scene, {.solver = Solver::small_steps, .backend = backend});
      for (int frame = 1; frame <= 90; ++frame) {
        const std::vector<Vec3> points = walking(shape, frame / 60.);
        REQUIRE(cloth.move_anchors(points));
        const StepReport report = step(cloth, 1. / 60);
        CAPTURE(std::string(name));
        CAPTURE(frame);
        CHECK(report.status == Status::converged);
        CHECK(report.max_strain <= 0.01 * (1 + 1e-6));
        const double reach = largest_reach(scene, cloth, points);
        CHECK(reach <= 0.05 + 1e-4);
        CHECK(report.max_anchor_error ==
              doctest::Approx(std::max(0.0, reach - 0.05)).epsilon(1e-3));
      }
    }
  }
}

TEST_CASE("a sheet that is laid on backstops stays above them and comes to rest") {
  for (const char* name : {"hang", "cape"}) {
    for (const double radius : {kInfinity, 1e3}) {
      SceneDescription scene = scene_of(name, 15);
      scene.fixed.clear();
      for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
        Vec3& x = scene.positions[i];
        x.y = 0.1 + 0.01 * std::sin(7 * x.x);
        Anchor anchor = plane({x.x, 0, x.z}, {0, 1, 0});
        anchor.backstop_radius = radius;
        anchor.particle = i;
        scene.anchors.push_back(anchor);
      }
      Cloth cloth = cloth_of(scene, {});
      for (int frame = 0; frame < 100; ++frame) {
        REQUIRE(step(cloth, 1. / 60).status == Status::converged);
        for (const Vec3 x : positions(cloth)) REQUIRE(x.y > -1e-4 - 2 / radius);
      }
      for (const Vec3 x : positions(cloth)) CHECK(x.y < 1e-3);
      CHECK(cloth.energy().kinetic < 1e-3);
    }
  }
}

TEST_CASE("anchors at rest bring no energy in") {
  for (const char* name : {"hang", "corners", "cape"}) {
    for (const double reach : {0., 0.02, 0.1}) {
      for (const Scheme scheme : {Scheme::implicit, Scheme::bdf2}) {
        SceneDescription scene = scene_of(name, 13);
        for (const std::uint32_t i : scene.fixed)
          scene.anchors.push_back(
              {.particle = i, .point = scene.positions[i], .max_distance = reach});
        scene.fixed.clear();
        Cloth cloth = cloth_of(scene, {.solver = Solver::small_steps, .scheme = scheme});
        const double start = cloth.energy().total();
        for (int frame = 0; frame < 120; ++frame) {
          CAPTURE(std::string(name));
          CAPTURE(reach);
          CAPTURE(frame);
          REQUIRE(step(cloth, 1. / 60).status == Status::converged);
          REQUIRE(cloth.energy().total() < start + 1e-3);
        }
      }
    }
  }
}

TEST_CASE("an anchor that is let go lets fall, and takes hold again without a blow") {
  for (const Backend backend : kBackends) {
    SceneDescription scene = one_particle({0, 0, 0}, {}, {.max_distance = 0.1});
    scene.anchors[0].normal = {0, 5, 0};
    scene.anchors[0].backstop_distance = 0.05;
    scene.anchors[0].backstop_radius = kInfinity;
    Cloth cloth = cloth_of(scene, small_steps(backend, 4));
    run(cloth, 0.01, 20);
    CHECK(cloth.position(0).y == doctest::Approx(-0.05).epsilon(1e-3));
    REQUIRE(cloth.limit_anchor(0, {.max_distance = kInfinity, .backstop = false}));
    run(cloth, 0.01, 50);
    CHECK(cloth.position(0).y == doctest::Approx(-0.05 - 0.5 * 10 * 0.25).epsilon(0.01));
    REQUIRE(cloth.write_velocities(std::vector<Vec3>(1)));
    const double start = -cloth.position(0).y;
    REQUIRE(cloth.limit_anchor(0, {.max_distance = 0.4, .backstop = false}));
    step(cloth, 0.01);
    CHECK(cloth.position(0).y == doctest::Approx(-0.4).epsilon(1e-6));
    CHECK(length(cloth.velocity(0)) < 0.2);
    CHECK(start > 1);
  }
}

TEST_CASE("a scale for all anchors lets a cloth go and takes it back, and those of 0 hold") {
  for (const Backend backend : kBackends) {
    SceneDescription scene = scene_of("cape", 9);
    scene.fixed.clear();
    anchor_all(scene, 0.05);
    for (Anchor& anchor : scene.anchors) {
      if (anchor.point.x < 0.1) anchor.max_distance = 0;
    }
    Cloth cloth = cloth_of(scene, small_steps(backend));
    const std::vector<Vec3> points = points_of(scene);
    for (const double scale : {0., 0.5, 2., 1.}) {
      REQUIRE(cloth.scale_anchors(scale));
      for (int frame = 0; frame < 30; ++frame) {
        const StepReport report = step(cloth, 0.01);
        CHECK(report.max_anchor_error <= 1e-4);
      }
      const double reach = largest_reach(scene, cloth, points);
      CAPTURE(scale);
      CHECK(reach <= 0.05 * scale + 1e-4);
      CHECK(reach >= 0.04 * scale);
    }
    for (const Anchor& anchor : scene.anchors) {
      if (anchor.max_distance == 0)
        CHECK(distance(cloth.position(anchor.particle), anchor.point) < 1e-6);
    }
  }
}

TEST_CASE("what anchors of 0 attach is held as by pins, by as many substeps, until it is let go") {
  for (const Backend backend : kBackends) {
    SceneDescription pinned = scene_of("hang", 17), attached = pinned;
    attached.fixed.clear();
    for (const std::uint32_t i : pinned.fixed)
      attached.anchors.push_back({.particle = i, .point = pinned.positions[i]});
    Cloth by_pins = cloth_of(pinned, small_steps(backend)),
          by_anchors = cloth_of(attached, small_steps(backend));
    std::vector<Vec3> points = points_of(attached);
    for (int frame = 0; frame < 20; ++frame) {
      for (Vec3& p : points) p.z += 0.01;
      REQUIRE(by_anchors.move_anchors(points));
      for (std::size_t i = 0; i < points.size(); ++i)
        REQUIRE(by_pins.move_fixed(pinned.fixed[i], points[i]));
      const StepReport pins = step(by_pins, 0.01), anchors = step(by_anchors, 0.01);
      CHECK(anchors.substeps == pins.substeps);
      CHECK(anchors.status == Status::converged);
      CHECK(anchors.pin_work == doctest::Approx(pins.pin_work).epsilon(0.05));
    }
    CHECK(largest_distance(positions(by_pins), positions(by_anchors)) < 1e-3);
    const std::uint32_t edge = pinned.fixed[0];
    CHECK(distance(by_anchors.velocity(edge), {0, 0, 1}) < 1e-3);
    const std::vector<AnchorLimit> let_go(points.size(), {.max_distance = kInfinity});
    REQUIRE(by_anchors.limit_anchors(let_go));
    const double height = by_anchors.position(edge).y;
    run(by_anchors, 0.01, 30);
    CHECK(by_anchors.position(edge).y < height - 0.3);
    std::vector<AnchorLimit> held(points.size(), {.max_distance = 0});
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i] = by_anchors.position(attached.anchors[i].particle);
    REQUIRE(by_anchors.move_anchors(points));
    REQUIRE(by_anchors.limit_anchors(held));
    CHECK(step(by_anchors, 0.01).max_anchor_error <= 1e-4);
    CHECK(distance(by_anchors.position(edge), points[0]) < 1e-6);
  }
}

TEST_CASE("what no anchor holds may fly as far as numbers go beside what one holds") {
  for (const Backend backend : kBackends) {
    SceneDescription scene = one_particle({0, 0, 0}, {}, {.max_distance = 0.1});
    scene.positions.push_back({1, 0, 0});
    scene.velocities.push_back({1e25, 0, 0});
    scene.masses.push_back(1);
    Cloth cloth = cloth_of(scene, small_steps(backend));
    const StepReport report = step(cloth, 0.01);
    CHECK(committed(report.status));
    CHECK(cloth.position(1).x == doctest::Approx(1e23));
    CHECK(distance(cloth.position(0), {0, 0, 0}) < 0.1 + 1e-4);
  }
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_anchors
