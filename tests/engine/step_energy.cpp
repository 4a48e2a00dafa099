/// Undamped scenes must never gain energy.
#include <doctest/doctest.h>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"

namespace weft::test {
namespace {

/// The largest total energy seen in a run, above that of its start, J.
double energy_gain(const SceneDescription& scene, const Settings& settings, int steps) {
  Cloth cloth = cloth_of(scene, settings);
  const double start = cloth.energy().total();
  double largest = 0;
  for (int k = 0; k < steps; ++k) {
    step(cloth, 0.01);
    largest = std::max(largest, cloth.energy().total() - start);
  }
  return largest;
}

TEST_CASE("hang never holds more energy than it started with") {
  for (const Method& method : kMethods) {
    for (const bool velocity_correction : {false, true}) {
      for (const double tolerance : {0.1, 0.01, 0.001}) {
        CAPTURE(text(method));
        CAPTURE(velocity_correction);
        CAPTURE(tolerance);
        Settings settings = with({}, method);
        settings.tolerance = tolerance;
        settings.velocity_correction = velocity_correction;
        CHECK(energy_gain(scene_of("hang", 8), settings, 200) < 1e-12);
      }
    }
  }
}

TEST_CASE("hang at full size never holds more energy than it started with" *
          doctest::test_suite("slow")) {
  for (const double tolerance : {0.1, 0.01, 1e-5}) {
    CAPTURE(tolerance);
    Settings settings;
    settings.tolerance = tolerance;
    CHECK(energy_gain(scene_of("hang", 20), settings, 200) < 1e-12);
  }
}

TEST_CASE("energy() is kinetic plus potential of what is not fixed") {
  SceneDescription scene = scene_of("corners", 5);
  scene.gravity = {1, -10, 2};
  scene.velocities.assign(scene.positions.size(), {1, 2, 3});
  Cloth cloth = cloth_of(scene, {});
  const double moving = scene.masses[0] * static_cast<double>(scene.positions.size() - 2);
  CHECK(cloth.energy().kinetic == doctest::Approx(moving * 14 / 2).epsilon(1e-14));
  CHECK(cloth.energy().total() ==
        doctest::Approx(energy(scene, scene.positions, scene.velocities)).epsilon(1e-13));
}

}  // namespace
}  // namespace weft::test
