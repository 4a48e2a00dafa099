/// The velocity loop of the yarn solver, against the direct solver's and the sweeps' meaning of it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/clothes.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_yarn_yarn_velocities {
namespace {

Settings corrected(Solver solver, double velocity_tolerance) {
  Settings settings = tight(1e-5);
  settings.solver = solver;
  settings.velocity_correction = true;
  settings.velocity_tolerance = velocity_tolerance;
  return settings;
}

std::vector<NamedScene> scenes() {
  return {{"hang", scene_of("hang", 20)},
          {"corners", scene_of("corners", 15)},
          {"ropes", braced_sheet(12)},
          {"random mesh", random_sheet(12, 5)},
          {"hang_sphere", scene_of("hang_sphere", 12)},
          {"sphere_drop", scene_of("sphere_drop", 12)}};
}

/// The fastest at which bars change their length, and ropes that are taut lengthen.
double largest_speed(const SceneDescription& scene, const Cloth& cloth, double tolerance) {
  const std::vector<bool> fixed = are_fixed(scene);
  double largest = 0;
  for (const Constraint& link : scene.constraints) {
    if (fixed[link.a] && fixed[link.b]) continue;
    const Vec3 d = cloth.position(link.a) - cloth.position(link.b);
    const double speed = dot(d, cloth.velocity(link.a) - cloth.velocity(link.b)) / length(d);
    const bool taut = length(d) >= (1 - tolerance) * link.rest_length;
    if (link.kind == ConstraintKind::distance) largest = std::max(largest, std::abs(speed));
    if (link.kind == ConstraintKind::rope && taut) largest = std::max(largest, speed);
  }
  return largest;
}

TEST_CASE("every speed along a constraint is within its tolerance") {
  for (const NamedScene& scene : scenes()) {
    for (const double tolerance : {0.01, 1e-5}) {
      CAPTURE(scene.name);
      CAPTURE(tolerance);
      Cloth cloth = cloth_of(scene.scene, corrected(Solver::yarn, tolerance));
      for (int k = 0; k < 30; ++k) {
        REQUIRE(step(cloth, 0.002).status == Status::converged);
        CHECK(largest_speed(scene.scene, cloth, 1e-5) <= tolerance * (1 + 1e-4));
      }
    }
  }
}

// From the same state: what contacts and ropes may do makes the answer unique.
TEST_CASE("one step leaves the velocities that the direct solver leaves") {
  for (const NamedScene& scene : scenes()) {
    CAPTURE(scene.name);
    Cloth found = cloth_of(scene.scene, corrected(Solver::yarn, 1e-6));
    Cloth expected = cloth_of(scene.scene, corrected(Solver::direct, 1e-6));
    double apart = 0;
    for (int k = 0; k < 60; ++k) {
      REQUIRE(expected.write_positions(positions(found)));
      REQUIRE(expected.write_velocities(velocities(found)));
      REQUIRE(step(found, 0.002).status == Status::converged);
      REQUIRE(step(expected, 0.002).status == Status::converged);
      apart = std::max(apart, largest_distance(velocities(found), velocities(expected)));
    }
    CHECK(apart < 0.005);
  }
}

TEST_CASE("passes do not grow with the tightness of the tolerance as those of sweeps do") {
  const auto passes = [](Solver solver, double tolerance) {
    Settings settings = corrected(solver, tolerance);
    settings.substeps = 4;
    Cloth cloth = cloth_of(scene_of("hang", 30), settings);
    std::int64_t sum = 0;
    for (int k = 0; k < 20; ++k) sum += step(cloth, 0.01).velocity_iterations;
    return sum;
  };
  CHECK(passes(Solver::yarn, 1e-5) < 20 * 4 * 8);
  CHECK(passes(Solver::gauss_seidel, 1e-5) > 20 * 4 * 100);
}

TEST_CASE("a fixed number of iterations is exactly that, by sweeps") {
  Settings settings = corrected(Solver::yarn, 0.01);
  settings.iterations = 3;
  Cloth cloth = cloth_of(scene_of("hang", 10), settings);
  for (int k = 0; k < 10; ++k) {
    const StepReport report = step(cloth, 0.005);
    CHECK(report.velocity_iterations == 3);
    CHECK(report.iterations == 3);
  }
}

}  // namespace
}  // namespace weft::test::engine_solvers_yarn_yarn_velocities
