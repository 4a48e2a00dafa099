#include "tools/studies/precision/reference_solution.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tools/scenes/scenes.h"

namespace weft::tools::precision {
namespace {

constexpr double kGravity = 10;

/// One particle on a rod of length 1, held at the origin.
SceneDescription pendulum(Vec3 position, Vec3 velocity) {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, position};
  scene.velocities = {{0, 0, 0}, velocity};
  scene.masses = {1, 0.3};
  scene.fixed = {0};
  scene.constraints = {{0, 1, 1}};
  return scene;
}

/// Let go level, after the quarter of a period in which it reaches its lowest point:
/// T/4 = K(sin(45 degrees)) sqrt(l/g).
double swing_error(int steps) {
  const double quarter = std::comp_ellint_1(std::sqrt(0.5)) / std::sqrt(kGravity);
  const auto motion = reference_solution(pendulum({1, 0, 0}, {}), quarter / steps, steps);
  REQUIRE(motion);
  return trajectory_error(motion.value().positions, {{0, 0, 0}, {0, -1, 0}});
}

SceneDescription built_in(const char* name, int size) {
  scenes::Options options;
  options.size = size;
  const auto scene = scenes::make(name, options);
  REQUIRE(scene);
  return scene.value();
}

/// A start at rest has energy 0 in `hang`.
double energy(const SceneDescription& scene, const Motion& motion) {
  double sum = 0;
  for (std::size_t i = 0; i < scene.masses.size(); ++i) {
    const Vec3& v = motion.velocities[i];
    const double square = v.x * v.x + v.y * v.y + v.z * v.z;
    sum += scene.masses[i] * (square / 2 + kGravity * motion.positions[i].y);
  }
  return sum;
}

TEST_CASE("a pendulum let go level: the closed form at its lowest point, second order") {
  CHECK(swing_error(1000) < 2e-6);
  CHECK(swing_error(200) / swing_error(400) == doctest::Approx(4).epsilon(0.02));
}

TEST_CASE("a step that is too large is refused, also where it leaves the range of numbers") {
  for (const double h : {1e3, 1e80, 1e200}) {
    CAPTURE(h);
    const auto motion = reference_solution(built_in("hang", 5), h, 2);
    REQUIRE_FALSE(motion);
    CHECK(motion.error().find("found no impulses") != std::string::npos);
  }
}

TEST_CASE("a conical pendulum goes round its circle") {
  const double tilt = std::numbers::pi / 3;
  const double rate = std::sqrt(kGravity / std::cos(tilt));
  const double radius = std::sin(tilt);
  const auto scene = pendulum({radius, -std::cos(tilt), 0}, {0, 0, rate * radius});
  const auto motion = reference_solution(scene, 0.0005, 2000);
  REQUIRE(motion);
  const Vec3 there{radius * std::cos(rate), -std::cos(tilt), radius * std::sin(rate)};
  CHECK(trajectory_error(motion.value().positions, {{0, 0, 0}, there}) < 2e-5);
}

TEST_CASE("a sheet: second order, every edge as long as it should be, energy kept") {
  const SceneDescription scene = built_in("hang", 6);
  const auto at = [&](int steps) {
    const auto motion = reference_solution(scene, 0.4 / steps, steps);
    REQUIRE(motion);
    return motion.value();
  };
  const Motion finest = at(1280);
  const double coarse = trajectory_error(at(80).positions, finest.positions);
  const double fine = trajectory_error(at(160).positions, finest.positions);
  CHECK(coarse / fine == doctest::Approx(4).epsilon(0.1));

  for (const Constraint& c : scene.constraints) {
    const Vec3 &a = finest.positions[c.a], &b = finest.positions[c.b];
    const double length = std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
    CHECK(std::abs(length / c.rest_length - 1) <= 1.1e-12);
  }
  CHECK(std::abs(energy(scene, finest)) < 1e-5);
  CHECK(std::abs(energy(scene, at(80))) > 1e-5);  // a step too large would be seen
}

TEST_CASE("fixed particles stay, and edges between them do not count") {
  SceneDescription scene = built_in("hang", 3);
  scene.constraints.push_back({0, 1, 9});
  const auto motion = reference_solution(scene, 0.001, 50);
  REQUIRE(motion);
  for (const std::uint32_t fixed : scene.fixed) {
    CHECK(motion.value().positions[fixed].y == 0);
    CHECK(motion.value().velocities[fixed].y == 0);
  }
  CHECK(motion.value().positions.back().y < -0.001);
}

TEST_CASE("what it does not know is refused") {
  SceneDescription scene = built_in("hang", 3);
  scene.constraints.front().kind = ConstraintKind::rope;
  const auto ropes = reference_solution(scene, 0.001, 1);
  REQUIRE_FALSE(ropes);
  CHECK(ropes.error() == "the reference solution knows no ropes");
  CHECK_FALSE(reference_solution(built_in("hang_sphere", 3), 0.001, 1));
}

TEST_CASE("impulses that are not found end the run with an error") {
  SceneDescription scene = built_in("hang", 3);
  scene.gravity = {0, -1e6, 0};
  CHECK_FALSE(reference_solution(scene, 0.1, 10));
}

TEST_CASE("the trajectory error is the largest distance, and a lost particle is not overlooked") {
  CHECK(trajectory_error({{0, 0, 0}, {1, 2, 2}}, {{0, 0, 0}, {0, 0, 0}}) == 3);
  CHECK(std::isnan(trajectory_error({{std::nan(""), 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {0, 0, 0}})));
}

}  // namespace
}  // namespace weft::tools::precision
