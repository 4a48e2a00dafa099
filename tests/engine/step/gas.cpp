/// Balloons, and gas that cloth encloses: rest, swings and work against closed forms.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/clothes.h"
#include "tests/support/pressed.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_gas {
namespace {

double mean_radius(const Cloth& cloth) {
  double sum = 0;
  for (const Vec3& x : positions(cloth)) sum += length(x);
  return sum / static_cast<double>(cloth.particle_count());
}

TEST_CASE("a balloon grows until its pressure is 2 T / r") {
  constexpr double kStiffness = 4000, kPressure = 800;
  for (const Settings& settings : kSmallSteps) {
    SceneDescription scene = balloon(2, kStiffness, 8);
    scene.pressures = {{.pressure = kPressure}};
    Settings tight = settings;
    tight.tolerance = 1e-3;
    Cloth cloth = cloth_of(scene, tight);
    run(cloth, 1. / 60, 60);
    CHECK(step(cloth, 1. / 60).status == Status::converged);
    // T = k (r - R) / R: warp and weft do not contract each other.
    const double radius = 1 / (1 / kBalloonRadius - kPressure / (2 * kStiffness));
    CHECK(mean_radius(cloth) - kBalloonRadius ==
          doctest::Approx(radius - kBalloonRadius).epsilon(0.06));  // a polyhedron
    CHECK(cloth.pressures()[0].pressure == kPressure);
    CHECK(cloth.pressures()[0].volume ==
          doctest::Approx(4. / 3 * M_PI * std::pow(radius, 3)).epsilon(0.05));
    double fastest = 0;
    for (const Vec3& v : velocities(cloth)) fastest = std::max(fastest, length(v));
    CHECK(fastest < 0.2);  // a ball without bending shivers
  }
}

TEST_CASE("damping of stretch leaves a balloon as large as its pressure makes it") {
  constexpr double kStiffness = 4000, kPressure = 800;
  const double strain = 1 / (1 - kPressure * kBalloonRadius / (2 * kStiffness)) - 1;
  for (const Settings& settings : kSmallSteps) {
    for (const double tau : {1e-3, 1e-2, 0.1}) {
      for (const double dt : {1. / 30, 1. / 60, 1. / 240}) {
        CAPTURE(tau);
        CAPTURE(dt);
        SceneDescription scene = balloon(2, kStiffness, 8);
        scene.damping.stretch = tau;
        scene.pressures = {{.pressure = kPressure}};
        Cloth cloth = cloth_of(scene, settings);
        run(cloth, dt, static_cast<int>(std::lround(0.5 / dt)));
        CHECK(step(cloth, dt).status == Status::converged);
        const double reached = mean_radius(cloth) / kBalloonRadius - 1;
        CHECK(std::abs(reached - strain) < cloth.settings().tolerance);
      }
    }
  }
}

TEST_CASE("a balloon that breathes gains no energy, and keeps most of it") {
  constexpr double kPressure = 600;
  for (const Settings& settings : kSmallSteps) {
    for (const double dt : {1. / 60, 1. / 240}) {
      CAPTURE(dt);
      Cloth cloth = cloth_of(balloon(2, 3000, 0), settings);
      REQUIRE(cloth.set_pressure(kPressure));
      const auto energy = [&] {
        return cloth.energy().total() - kPressure * cloth.pressures()[0].volume;
      };
      const double start = energy();
      double most = start;
      for (int k = 0; k < 30; ++k) {
        step(cloth, dt);
        most = std::max(most, energy());
      }
      const double whole = kPressure * 4. / 3 * M_PI * std::pow(kBalloonRadius, 3) * 0.3;
      CHECK(most - start < 0.02 * whole);
    }
  }
}

// ------------------------------------------------------------------------------------------ gas

/// A column of gas, 1 m high and 0.25 m^2 wide, under a rigid piston of 5 kg that gravity loads.
SceneDescription piston(double ambient, double damping) {
  SceneDescription scene;
  for (const double y : {0., 1.}) {
    for (const double x : {-0.25, 0.25}) {
      for (const double z : {-0.25, 0.25}) scene.positions.push_back({x, y, z});
    }
  }
  scene.masses.assign(8, 1.25);
  scene.fixed = {0, 1, 2, 3};
  for (std::uint32_t a = 4; a < 8; ++a) {
    for (std::uint32_t b = a + 1; b < 8; ++b)
      scene.constraints.push_back({a, b, distance(scene.positions[a], scene.positions[b])});
  }
  scene.surface = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  scene.damping.motion = damping;
  scene.pressures = {{.pressure = 0, .gas = true, .ambient = ambient}};
  return scene;
}

TEST_CASE("a gas under a piston keeps its pressure times its volume") {
  constexpr double kAmbient = 1000, kArea = 0.25;
  for (const Settings& settings : kSmallSteps) {
    for (const double mass : {5., 20.}) {
      CAPTURE(mass);
      SceneDescription scene = piston(kAmbient, 4);
      for (std::uint32_t i = 4; i < 8; ++i) scene.masses[i] = mass / 4;
      Settings tight = settings;
      tight.tolerance = 1e-5;  // or the gas makes the piston wider
      Cloth cloth = cloth_of(scene, tight);
      CHECK(cloth.pressures()[0].volume == doctest::Approx(kArea));
      CHECK(cloth.pressures()[0].pressure == doctest::Approx(0));
      run(cloth, 1. / 60, 300);
      const double height = kAmbient / (kAmbient + 10 * mass / kArea);
      CHECK(cloth.position(4).y == doctest::Approx(height).epsilon(0.01));  // it turns a little
      const PressureNow now = cloth.pressures()[0];
      CHECK(now.pressure == doctest::Approx(10 * mass / kArea).epsilon(0.01));
      CHECK(now.volume == doctest::Approx(kArea * height).epsilon(4e-3));
      CHECK((kAmbient + now.pressure) * now.volume == doctest::Approx(kAmbient * kArea));
    }
  }
}

TEST_CASE("a piston swings on a gas with its frequency, and gains no energy") {
  constexpr double kAmbient = 4000, kMass = 5, kArea = 0.25;
  for (const Settings& settings : kSmallSteps) {
    SceneDescription scene = piston(kAmbient, 0);
    scene.velocities.assign(8, {});
    scene.gravity = {};
    for (std::uint32_t i = 4; i < 8; ++i) scene.velocities[i] = {0, -0.3, 0};
    Cloth cloth = cloth_of(scene, settings);
    const double expected = std::sqrt(kAmbient * kArea / kMass) / (2 * M_PI);
    constexpr double kTime = 1. / 240;
    int crossings = 0;
    double first = 0, last = 0, before = 1, fastest = 0;
    for (int k = 1; k <= 480; ++k) {
      step(cloth, kTime);
      const double y = cloth.position(4).y;
      fastest = std::max(fastest, std::abs(cloth.velocity(4).y));
      if ((y - 1) * (before - 1) < 0) {
        (crossings++ == 0 ? first : last) = (k - (y - 1) / (y - before)) * kTime;
      }
      before = y;
    }
    CHECK((crossings - 1) / (2 * (last - first)) == doctest::Approx(expected).epsilon(0.02));
    CHECK(fastest < 0.301);
  }
}

TEST_CASE("a bag that lies flat is blown up by the volume that its gas has elsewhere") {
  for (const Settings& settings : kSmallSteps) {
    SceneDescription scene = balloon(2, 4000, 8);
    scene.pressures = {{.pressure = 2000, .gas = true}};
    Cloth cloth = cloth_of(scene, settings);
    const double volume = cloth.pressures()[0].volume;
    for (Vec3& x : scene.positions) x.y *= 0.01;
    scene.pressures[0].volume = volume;
    Cloth flat = cloth_of(scene, settings);
    CHECK(flat.pressures()[0].volume < 0.02 * volume);
    CHECK(flat.pressures()[0].pressure > 1e6);
    run(cloth, 1. / 60, 90);
    run(flat, 1. / 60, 90);
    CHECK(flat.pressures()[0].volume == doctest::Approx(cloth.pressures()[0].volume).epsilon(0.01));
  }
}

}  // namespace
}  // namespace weft::test::engine_step_gas
