/// Motions whose outcome is known on paper.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_closed_forms {
namespace {

TEST_CASE("unconstrained particles follow their parabolas exactly") {
  const Backend backend = each_backend();
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 2, 3}};
  scene.velocities = {{1, 2, 3}, {-1, 0, 0}};
  scene.masses = {2, 0.5};
  scene.gravity = {0, -10, 1};
  const Vec3 force{4, 1, -2};
  Cloth cloth = cloth_of(scene, on(backend));
  REQUIRE(cloth.write_forces(std::vector<Vec3>{force, {0, 0, 0}}));

  run(cloth, 0.01, 100);

  const double t = 1;
  const Vec3 pushed = scene.gravity + 0.5 * force;
  CHECK(distance(cloth.position(0), t * scene.velocities[0] + t * t / 2 * pushed) < 1e-13);
  CHECK(distance(cloth.velocity(0), scene.velocities[0] + t * pushed) < 1e-13);
  const Vec3 fallen = t * scene.velocities[1] + t * t / 2 * scene.gravity;
  CHECK(distance(cloth.position(1), scene.positions[1] + fallen) < 1e-13);

  REQUIRE(cloth.write_forces({}));
  const Vec3 before = cloth.velocity(0);
  step(cloth, 0.01);
  CHECK(distance(cloth.velocity(0), before + 0.01 * scene.gravity) < 1e-14);
}

// A free bar of length L that spins at omega, seen from its centre: with r the vector between its
// ends, a step previews r + h r' and shortens it along itself back to L, so that r turns by
// theta = atan(h omega). The new r' is (new r - old r) / h: beside its tangential part L sin(theta)
// it points inwards by L (1 - cos(theta)), so the next step turns by
//     theta' = atan(sin(theta) / (2 - cos(theta))),
// or, where the velocity correction has removed the inward part, by theta' = atan(sin(theta)).
void check_spinning_bar(Backend backend, bool velocity_correction,
                        const std::function<double(double)>& next) {
  constexpr double kOmega = 5;
  constexpr double kStep = 0.01;
  const Vec3 drift{0.3, -0.2, 0.7};
  SceneDescription scene = free_bar(3, 1);
  scene.velocities = {drift - Vec3{0, 0.25 * kOmega, 0}, drift + Vec3{0, 0.75 * kOmega, 0}};
  Settings settings = on(backend, tight(1e-14));
  settings.velocity_correction = velocity_correction;
  Cloth cloth = cloth_of(scene, settings);

  double theta = std::atan(kStep * kOmega);
  double angle = 0;
  for (int k = 1; k <= 100; ++k) {
    step(cloth, kStep);
    angle += theta;
    theta = next(theta);
    const Vec3 centre = Vec3{0.25, 0, 0} + k * kStep * drift;
    const Vec3 bar{std::cos(angle), std::sin(angle), 0};
    // Each step corrects omega^2 h^2 / 2 of a length; what is rounded off stays in the velocities.
    const double rounding = exactness(backend, 1e-12, k * k * kOmega * kOmega * kStep * kStep / 2);
    REQUIRE(distance(cloth.position(0), centre - 0.25 * bar) < rounding);
    REQUIRE(distance(cloth.position(1), centre + 0.75 * bar) < rounding);
  }
}

TEST_CASE("a free bar of unequal masses drifts and spins as the scheme's closed form says") {
  const Backend backend = each_backend();
  check_spinning_bar(backend, false, [](double theta) {
    return std::atan(std::sin(theta) / (2 - std::cos(theta)));
  });
}

TEST_CASE("velocity correction leaves a spinning bar only its tangential velocity") {
  const Backend backend = each_backend();
  check_spinning_bar(backend, true, [](double theta) { return std::atan(std::sin(theta)); });
}

TEST_CASE("a stretched bar at rest closes along its line, by shares of mass, and stays at rest") {
  const Backend backend = each_backend();
  SceneDescription scene = free_bar(3, 1);
  scene.constraints[0].rest_length = 0.6;
  Cloth cloth = cloth_of(scene, on(backend, tight(1e-12)));
  step(cloth, 0.01);
  CHECK(distance(cloth.position(0), {0.1, 0, 0}) < exactness(backend, 1e-15, 0.4));
  CHECK(distance(cloth.position(1), {0.7, 0, 0}) < exactness(backend, 1e-15, 0.4));
  for (const std::uint32_t i : {0u, 1u}) {
    CHECK(length(cloth.velocity(i)) < exactness(backend, 1e-12, 40));
  }
}

/// The time that a pendulum of length 1, released at rest at `amplitude`, takes to hang straight.
double quarter_period(Backend backend, double amplitude, double dt, bool velocity_correction) {
  SceneDescription scene = free_bar(1, 1);
  scene.positions[1] = {std::sin(amplitude), -std::cos(amplitude), 0};
  scene.fixed = {0};
  scene.gravity = {0, -10, 0};
  Settings settings = on(backend, tight(1e-13));
  settings.velocity_correction = velocity_correction;
  Cloth cloth = cloth_of(scene, settings);
  double before = scene.positions[1].x;
  for (int k = 1;; ++k) {
    step(cloth, dt);
    const double now = cloth.position(1).x;
    if (now <= 0) return dt * (k - now / (now - before));
    before = now;
  }
}

double exact_quarter_period(double amplitude) {
  return std::sqrt(0.1) * std::comp_ellint_1(std::sin(amplitude / 2));
}

TEST_CASE("a pendulum keeps the period of the elliptic integral, to first order in dt") {
  const Backend backend = each_backend();
  for (const double degrees : {1.0, 60.0, 120.0}) {
    for (const bool velocity_correction : {false, true}) {
      CAPTURE(degrees);
      CAPTURE(velocity_correction);
      const double amplitude = degrees * std::numbers::pi / 180;
      const double exact = exact_quarter_period(amplitude);
      const double coarse = quarter_period(backend, amplitude, 2e-4, velocity_correction);
      const double fine = quarter_period(backend, amplitude, 1e-4, velocity_correction);
      CHECK(std::abs(fine - exact) < 1e-3 * exact);
      CHECK((coarse - exact) / (fine - exact) == doctest::Approx(2).epsilon(0.05));
      CHECK(std::abs(2 * fine - coarse - exact) < 1e-6 * exact);
    }
  }
}

TEST_CASE("a fixed particle stays, whatever its velocity and the forces say") {
  const Backend backend = each_backend();
  SceneDescription scene = free_bar(1, 1);
  scene.gravity = {0, -10, 0};
  scene.fixed = {0};
  Cloth cloth = cloth_of(scene, on(backend, tight(1e-10)));
  REQUIRE(cloth.write_forces(std::vector<Vec3>{{5, 5, 5}, {0, 0, 0}}));
  run(cloth, 0.01, 50);
  CHECK(distance(cloth.position(0), {0, 0, 0}) == 0);
  CHECK(cloth.position(1).y < -0.5);
}

TEST_CASE("a moved pin takes its bar along at the next step") {
  const Backend backend = each_backend();
  SceneDescription scene = free_bar(1, 1);
  scene.fixed = {0};
  Cloth cloth = cloth_of(scene, on(backend, tight(1e-10)));
  REQUIRE(cloth.move_fixed(0, {-0.1, 0, 0}));
  CHECK(distance(cloth.position(0), {-0.1, 0, 0}) == 0);
  step(cloth, 0.01);
  CHECK(distance(cloth.position(0), {-0.1, 0, 0}) == 0);
  CHECK(distance(cloth.position(1), {0.9, 0, 0}) < exactness(backend, 1e-9, 0.1));
}

}  // namespace
}  // namespace weft::test::engine_step_closed_forms
