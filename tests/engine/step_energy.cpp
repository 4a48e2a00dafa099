/// Undamped scenes must not gain energy.
///
/// The scheme removes a whole error e in one step and thereby adds speeds of up to e / h. A level
/// sheet that is let go falls freely until some edge is out of tolerance, and is caught then: by an
/// error of at most the tolerance and of what one more step adds, d^2 / (2 L) with d = g h^2 / 2
/// from rest. Only there may energy appear, and no more than all of the mass has at that speed.
#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"

namespace weft::test {
namespace {

constexpr double kStep = 0.01;

/// The total energy after every one of 200 steps, less that of the start, J.
std::vector<double> energy_gains(const SceneDescription& scene, const Settings& settings) {
  Cloth cloth = cloth_of(scene, settings);
  const double start = cloth.energy().total();
  std::vector<double> gains;
  for (int k = 0; k < 200; ++k) {
    step(cloth, kStep);
    gains.push_back(cloth.energy().total() - start);
  }
  return gains;
}

double energy_of_the_catch(int size, double tolerance) {
  const double spacing = 1.0 / (size - 1);
  const double fall = 10 * kStep * kStep / 2;
  const double error = tolerance * spacing + fall * fall / (2 * spacing);
  return (error / kStep) * (error / kStep) / 2;
}

void check_hang(int size, const Settings& settings) {
  const std::vector<double> gains = energy_gains(scene_of("hang", size), settings);
  const double most = *std::max_element(gains.begin(), gains.end());
  CHECK(most < energy_of_the_catch(size, settings.tolerance));
  CHECK(*std::max_element(gains.begin() + 30, gains.end()) < 0);
  if (settings.tolerance == 0.01) CHECK(most < 1e-12);
}

TEST_CASE("hang never holds more energy than it started with") {
  for (const Method& method : kAllMethods) {
    for (const bool velocity_correction : {false, true}) {
      for (const double tolerance : {0.1, 0.01, 0.001}) {
        CAPTURE(text(method));
        CAPTURE(velocity_correction);
        CAPTURE(tolerance);
        Settings settings = with(paper_settings(), method);
        settings.tolerance = tolerance;
        settings.velocity_correction = velocity_correction;
        check_hang(8, settings);
      }
    }
  }
}

TEST_CASE("hang at full size never holds more energy than it started with" *
          doctest::test_suite("slow")) {
  const Backend backend = each_backend();
  for (const double tolerance : {0.1, 0.01, 1e-5}) {
    for (const bool velocity_correction : {false, true}) {
      CAPTURE(tolerance);
      CAPTURE(velocity_correction);
      Settings settings = on(backend);
      settings.tolerance = tolerance;
      settings.velocity_correction = velocity_correction;
      check_hang(20, settings);
    }
  }
}

/// What a frame leaves within tolerance, divided by 10 us, would be metres per second.
TEST_CASE("a step far shorter than the last one makes no speed of what that one left") {
  constexpr double kFrame = 1. / 60, kRest = 1e-5;
  for (const Solver solver : {Solver::automatic, Solver::direct}) {
    for (const Scheme scheme : {Scheme::paper, Scheme::rattle}) {
      CAPTURE(name(solver));
      CAPTURE(name(scheme));
      Cloth cloth = cloth_of(scene_of("hang", 20), {.solver = solver, .scheme = scheme});
      const double start = cloth.energy().total();
      for (int k = 0; k < 100; ++k) {
        REQUIRE(step(cloth, kFrame).status == Status::converged);
        CHECK(cloth.energy().total() < start + 1e-5);
        REQUIRE(step(cloth, kRest).status == Status::converged);
        CHECK(cloth.energy().total() < start + 1e-5);
      }
    }
  }
}

TEST_CASE("energy() is kinetic plus potential of what is not fixed") {
  const Backend backend = each_backend();
  for (const int size : {5, 21}) {  // 21: slots without a particle stand between the others
    CAPTURE(size);
    SceneDescription scene = scene_of("corners", size);
    scene.gravity = {1, -10, 2};
    scene.velocities.assign(scene.positions.size(), {1, 2, 3});
    Cloth cloth = cloth_of(scene, on(backend));
    const double moving = scene.masses[0] * static_cast<double>(scene.positions.size() - 2);
    CHECK(cloth.energy().kinetic == doctest::Approx(moving * 14 / 2).epsilon(1e-13));
    CHECK(cloth.energy().total() ==
          doctest::Approx(energy(scene, scene.positions, scene.velocities)).epsilon(1e-12));
  }
}

}  // namespace
}  // namespace weft::test
