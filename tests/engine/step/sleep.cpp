/// A cloth that rests sleeps, if it may, until something changes.
#include <doctest/doctest.h>
#include <weft/weft.h>

#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_sleep {
namespace {

constexpr double kDt = 1 / 60.;

SceneDescription decaying(const char* name, int size, double rate) {
  SceneDescription scene = scene_of(name, size);
  scene.damping.motion = rate;
  return scene;
}

bool falls_asleep(Cloth& cloth, int frames) {
  for (int frame = 0; frame < frames; ++frame) {
    if (step(cloth, kDt).asleep) return true;
  }
  return false;
}

/// A sheet that hangs from a row and sleeps.
Cloth asleep() {
  Cloth cloth = cloth_of(decaying("hang", 6, 8), {.sleep = true});
  REQUIRE(falls_asleep(cloth, 600));
  return cloth;
}

TEST_CASE("a sheet that hangs still sleeps: it stays where it is, and says what it said before") {
  Cloth cloth = asleep();
  const std::vector<Vec3> where = positions(cloth);
  const std::uint64_t hash = cloth.state_hash();
  for (int frame = 0; frame < 100; ++frame) {
    const StepReport report = step(cloth, kDt);
    CHECK(report.asleep);
    CHECK(report.substeps == 0);
    CHECK(report.iterations == 0);
    CHECK(report.status == Status::converged);
    CHECK(report.max_strain > 0);
    CHECK(report.max_strain <= 0.01);
  }
  CHECK(cloth.state_hash() == hash);
  for (const Vec3& v : velocities(cloth)) CHECK(length(v) == 0);

  Cloth awake = cloth_of(decaying("hang", 6, 8), {});
  run(awake, kDt, 700);
  CHECK(largest_distance(where, positions(awake)) < 1e-4);
}

TEST_CASE("without the setting none sleeps, and until it sleeps none knows of it") {
  const SceneDescription scene = decaying("corners", 7, 4);
  Cloth may = cloth_of(scene, {.sleep = true}), may_not = cloth_of(scene, {});
  int frames = 0;
  while (!step(may, kDt).asleep) {
    REQUIRE(++frames < 1200);
    CHECK_FALSE(step(may_not, kDt).asleep);
    if (length(may.velocity(20)) > 0) CHECK(may.state_hash() == may_not.state_hash());
  }
  CHECK(frames > 60);
}

TEST_CASE("what swings does not sleep, nor at its turning points") {
  Cloth cloth = cloth_of(scene_of("hang", 6), {.sleep = true});
  CHECK_FALSE(falls_asleep(cloth, 900));
}

TEST_CASE("nor does what creeps") {
  SceneDescription scene = scene_of("hang", 5);
  scene.fixed.clear();
  scene.gravity = {};
  scene.velocities.assign(scene.positions.size(), {1.5e-3, 0, 0});  // of 0.25 m
  Cloth cloth = cloth_of(scene, {.sleep = true});
  CHECK_FALSE(falls_asleep(cloth, 120));
}

TEST_CASE("steps that are too long to know what is between them let nothing sleep") {
  Cloth cloth = cloth_of(decaying("hang", 6, 8), {.sleep = true});
  for (int k = 0; k < 60; ++k) CHECK_FALSE(step(cloth, 0.2).asleep);
}

TEST_CASE("any change wakes it, the same values again do not") {
  struct Touch {
    const char* name;
    std::function<void(Cloth&)> same, other;
  };
  const auto pin = [](const Cloth& cloth) { return cloth.position(0); };
  const std::vector<Vec3> none(36), some(36, {0, 0, 1e-3});
  const Touch touches[] = {
      {"gravity",
       [](Cloth& c) {
         REQUIRE(c.set_gravity({0, -10, 0}));
       },
       [](Cloth& c) {
         REQUIRE(c.set_gravity({0, -9.81, 0}));
       }},
      {"wind",
       [](Cloth& c) {
         REQUIRE(c.set_wind({0, 0, 0}));
       },
       [](Cloth& c) {
         REQUIRE(c.set_wind({0, 0, 1}));
       }},
      {"forces", [](Cloth& c) { REQUIRE(c.write_forces({})); },
       [&](Cloth& c) { REQUIRE(c.write_forces(some)); }},
      {"pin", [&](Cloth& c) { REQUIRE(c.move_fixed(0, pin(c))); },
       [&](Cloth& c) {
         REQUIRE(c.move_fixed(0, {pin(c).x + 1e-3, pin(c).y, pin(c).z}));
       }},
      {"placed pin", [](Cloth&) {}, [&](Cloth& c) { REQUIRE(c.place_fixed(0, pin(c))); }},
      {"carry", [](Cloth& c) { REQUIRE(c.carry({}, 1)); },
       [](Cloth& c) {
         REQUIRE(c.carry({.translation = {0, 0, 1e-3}}, 1));
       }},
      {"positions", [](Cloth&) {}, [](Cloth& c) { REQUIRE(c.write_positions(positions(c))); }},
      {"velocities", [](Cloth&) {}, [](Cloth& c) { REQUIRE(c.write_velocities(velocities(c))); }},
      {"mass", [](Cloth& c) { REQUIRE(c.change({})); },
       [](Cloth& c) {
         REQUIRE(c.change({.masses = {{20, 0.04}}}));
       }},
      {"decay", [](Cloth&) {},
       [](Cloth& c) { REQUIRE(c.change({.damping = Damping{.motion = 4}})); }},
  };
  for (const Touch& touch : touches) {
    CAPTURE(std::string(touch.name));
    Cloth cloth = asleep();
    touch.same(cloth);
    CHECK(step(cloth, kDt).asleep);
    touch.other(cloth);
    CHECK_FALSE(step(cloth, kDt).asleep);
    CHECK(falls_asleep(cloth, 1200));
  }
}

TEST_CASE("a sphere that is moved wakes it") {
  SceneDescription scene = decaying("hang", 6, 8);
  const auto sphere = static_cast<std::uint32_t>(scene.positions.size());
  scene.positions.push_back({5, 0, 0});
  scene.masses.push_back(1);
  scene.fixed.push_back(sphere);
  scene.spheres = {sphere};
  scene.radii.assign(scene.positions.size(), 0);
  scene.radii.back() = 0.1;
  Cloth cloth = cloth_of(scene, {.sleep = true});
  REQUIRE(falls_asleep(cloth, 600));
  REQUIRE(cloth.move_fixed(sphere, {4, 0, 0}));
  CHECK_FALSE(step(cloth, kDt).asleep);
}

TEST_CASE(
    "points that move wake a cloth that sleeps on its anchors, the same points again do not") {
  for (const double reach : {0., 0.02}) {
    SceneDescription scene = decaying("hang", 6, 8);
    for (const std::uint32_t i : scene.fixed)
      scene.anchors.push_back({.particle = i, .point = scene.positions[i], .max_distance = reach});
    scene.fixed.clear();
    std::vector<Vec3> points;
    for (const Anchor& anchor : scene.anchors) points.push_back(anchor.point);
    const auto asleep_on_anchors = [&] {
      Cloth cloth = cloth_of(scene, {.sleep = true});
      REQUIRE(falls_asleep(cloth, 900));
      return cloth;
    };
    CAPTURE(reach);
    Cloth cloth = asleep_on_anchors();
    REQUIRE(cloth.move_anchors(points));
    CHECK(step(cloth, kDt).asleep);
    for (Vec3& point : points) point.z += 1e-3;
    REQUIRE(cloth.move_anchors(points));
    CHECK_FALSE(step(cloth, kDt).asleep);
    CHECK(falls_asleep(cloth, 1200));
    Cloth scaled = asleep_on_anchors(), let_go = asleep_on_anchors();
    REQUIRE(scaled.scale_anchors(2));
    CHECK(step(scaled, kDt).asleep == (reach == 0));
    REQUIRE(let_go.limit_anchor(0, {.max_distance = 1}));
    CHECK_FALSE(step(let_go, kDt).asleep);
  }
}

TEST_CASE("a clone of one that sleeps sleeps, and wakes by itself") {
  Cloth cloth = asleep(), clone = cloth.clone();
  REQUIRE(clone.set_gravity({0, -5, 0}));
  CHECK_FALSE(step(clone, kDt).asleep);
  CHECK(step(cloth, kDt).asleep);
}

/// s of processor time a step: others that run meanwhile do not count.
double seconds_of(Cloth& cloth, int steps) {
  const std::clock_t start = std::clock();
  run(cloth, kDt, steps);
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / steps;
}

TEST_CASE("a step of one that sleeps takes a fiftieth of what it took to move") {
  Cloth cloth = cloth_of(decaying("hang", 20, 8), {.sleep = true});
  const double moving = seconds_of(cloth, 20);
  REQUIRE(falls_asleep(cloth, 900));
  CHECK(seconds_of(cloth, 2000) < moving / 50);
}

}  // namespace
}  // namespace weft::test::engine_step_sleep
