/// Settings::anticipate_products: errors kept up to date through the products of directions,
/// against errors formed from displacements.
///
/// Without ropes, hubs and contacts both visit the same constraints in the same order, so that from
/// the same state a step does the same, but for what floats round off in 32 iterations along the
/// same directions. With them, and where an error is so near the tolerance that the two decide
/// differently, they take other ways to an equally good end: a handful of tolerances away.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_products {
namespace {

constexpr double kStep = 0.01;
constexpr double kRounding = 4 * 32 * 0x1p-24;

Settings products(Settings settings = paper_settings()) {
  settings.backend = Backend::simd;
  settings.measuring.anticipate = settings.measuring.anticipate_products = true;
  return settings;
}

/// f(settings) for directions, velocity correction and skipping.
template <class F>
void for_every_method(const Settings& common, F f) {
  for (const Directions directions : {Directions::each, Directions::frozen}) {
    for (const bool velocity_correction : {false, true}) {
      for (const bool skip : {false, true}) {
        CAPTURE(name(directions));
        CAPTURE(velocity_correction);
        CAPTURE(skip);
        Settings settings = common;
        settings.measuring.directions = directions;
        settings.velocity_correction = velocity_correction;
        settings.measuring.skip = skip;
        f(settings);
      }
    }
  }
}

/// Every step starts both from the same state. Returns how many steps ended within rounding of each
/// other.
int steps_alike(const SceneDescription& scene, const Settings& settings, int steps) {
  Settings by_displacements = settings;
  by_displacements.measuring.anticipate_products = false;
  Cloth expected = cloth_of(scene, by_displacements), found = cloth_of(scene, settings);
  double shortest = 1;
  for (const Constraint& c : scene.constraints) shortest = std::min(shortest, c.rest_length);
  int alike = 0;
  for (int k = 0; k < steps; ++k) {
    CAPTURE(k);
    const std::vector<Vec3> before = positions(expected), velocity = velocities(expected);
    REQUIRE(found.write_positions(before));
    REQUIRE(found.write_velocities(velocity));
    const StepReport wanted = step(expected, kStep), report = step(found, kStep);
    REQUIRE(wanted.status == Status::converged);
    REQUIRE(report.status == Status::converged);
    REQUIRE(max_strain(scene, positions(found)) <= settings.tolerance * (1 + 1e-9));
    REQUIRE(max_penetration(scene, positions(found)) <= settings.contact_tolerance * (1 + 1e-9));
    double moved = 0;  // from where particles would have flown
    const std::vector<Vec3> after = positions(expected);
    const std::vector<bool> fixed = are_fixed(scene);
    for (std::size_t i = 0; i < after.size(); ++i) {
      if (fixed[i]) continue;
      const Vec3 flown = before[i] + kStep * velocity[i] + (kStep * kStep / 2) * scene.gravity;
      moved = std::max(moved, distance(flown, after[i]));
    }
    const double apart = largest_distance(positions(found), after);
    REQUIRE(apart <= 10 * settings.tolerance * std::max(shortest, moved));
    alike += apart <= kRounding * moved + 1e-15 && report.iterations == wanted.iterations &&
             report.corrections == wanted.corrections;
  }
  return alike;
}

TEST_CASE("products lead where displacements do, step by step") {
  for (const char* name : {"hang", "corners"}) {
    CAPTURE(std::string(name));
    const SceneDescription scene = scene_of(name, 21);
    for_every_method(products(),
                     [&](const Settings& s) { CHECK(steps_alike(scene, s, 40) >= 38); });
  }
  const SceneDescription mesh = random_sheet(15, 3);  // in quads
  for_every_method(products(), [&](const Settings& s) { CHECK(steps_alike(mesh, s, 20) >= 18); });
  const SceneDescription tiles = scene_of("hang", 90);
  CHECK(steps_alike(tiles, products(), 8) >= 7);
}

TEST_CASE("with ropes, hubs and spheres they lead to an equally good end") {
  for (const SceneDescription& scene : {roped_sheet(16), hub_sheet(9)}) {
    for_every_method(products(), [&](const Settings& s) { steps_alike(scene, s, 20); });
  }
}

TEST_CASE("every step ends with every true error within tolerance") {
  struct Case {
    const char* name;
    int size, steps;
    double tolerance;
  };
  for (const Case c :
       {Case{"hang", 2, 20, 0.01}, Case{"hang", 5, 40, 1e-5}, Case{"hang", 13, 60, 0.1},
        Case{"hang", 41, 20, 0.001}, Case{"hang_sphere", 9, 100, 0.01},
        Case{"hang_sphere", 21, 60, 0.001}, Case{"sphere_drop", 9, 60, 0.01},
        Case{"corners", 9, 40, 0.001}, Case{"cape", 12, 20, 0.01}}) {
    CAPTURE(std::string(c.name));
    CAPTURE(c.size);
    CAPTURE(c.tolerance);
    const SceneDescription scene = scene_of(c.name, c.size);
    Settings common = products();
    common.tolerance = c.tolerance;
    for_every_method(common, [&](const Settings& settings) {
      Cloth cloth = cloth_of(scene, settings);
      for (int k = 0; k < c.steps; ++k) {
        CAPTURE(k);
        REQUIRE(step(cloth, kStep).status == Status::converged);
        const std::vector<Vec3> now = positions(cloth);
        REQUIRE(max_strain(scene, now) <= c.tolerance * (1 + 1e-9));
        REQUIRE(max_penetration(scene, now) <= settings.contact_tolerance * (1 + 1e-9));
      }
    });
  }
}

TEST_CASE("ropes, hubs and several tiles end within tolerance, by scheme rattle as well") {
  for (const SceneDescription& scene :
       {roped_sheet(9), roped_sheet(70), hub_sheet(12), random_sheet(12, 2)}) {
    for (const Scheme scheme : {Scheme::paper, Scheme::rattle}) {
      CAPTURE(scene.positions.size());
      CAPTURE(name(scheme));
      Settings settings = products();
      settings.scheme = scheme;
      Cloth cloth = cloth_of(scene, settings);
      for (int k = 0; k < 6; ++k) {
        REQUIRE(step(cloth, 0.001).status == Status::converged);
        REQUIRE(max_strain(scene, positions(cloth)) <= settings.tolerance * (1 + 1e-9));
      }
    }
  }
}

TEST_CASE("a fixed number of iterations leads where it does without products") {
  const SceneDescription scene = scene_of("hang", 41);
  Settings settings = products();
  settings.iterations = 20;
  Cloth found = cloth_of(scene, settings);
  settings.measuring.anticipate_products = false;
  Cloth expected = cloth_of(scene, settings);
  for (int k = 0; k < 10; ++k) {
    const StepReport report = step(found, kStep), wanted = step(expected, kStep);
    CHECK(report.iterations == wanted.iterations);
    CHECK(report.visits == wanted.visits);
  }
  CHECK(largest_distance(positions(found), positions(expected)) < 1e-6);
}

TEST_CASE("memory for products is held where they are asked for") {
  const SceneDescription scene = scene_of("hang", 20);
  const auto model = model_of(scene);
  Settings settings = paper_settings();
  const auto plain = Cloth::create(model, settings);
  REQUIRE(plain);
  const std::size_t before = describe(*model).bytes, without = plain.value().bytes();
  const auto keeping = Cloth::create(model, products());
  REQUIRE(keeping);
  CHECK(describe(*model).bytes > before);
  CHECK(keeping.value().bytes() > without + 400 * 2 * 6 * 2 * sizeof(float));
  CHECK(Cloth::create(model, settings).value().bytes() == without);
}

}  // namespace
}  // namespace weft::test::engine_step_products
