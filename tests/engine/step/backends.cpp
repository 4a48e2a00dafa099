/// The simd backend against the reference. Both visit the same constraints in the same order, so
/// from the same state a step does the same on both: as many iterations, as many corrections, and
/// positions that differ by what floats round off.
///
/// Between two renewals of the directions a displacement is summed up in at most 32 iterations,
/// each of which rounds it by a part in 2^24. What an error in one renewal leaves, the next sees
/// and mends. So positions differ by at most 32 x 2^-24 of the largest displacement.
///
/// It may also happen, rarely, that an error is so near the tolerance that the two decide
/// differently. From there on they take other ways to an equally good end: a handful of tolerances
/// away.
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/support/clothes.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_backends {
namespace {

constexpr double kStep = 0.01;
constexpr double kRounding = 32 * 0x1p-24;

struct Case {
  NamedScene scene;
  double tolerance = 0.01;
  int steps = 60;
  int decided_otherwise = 0;  // steps, at most
};

/// The largest way from where a particle would have flown to where the step put it.
double largest_displacement(const SceneDescription& scene, const std::vector<Vec3>& before,
                            const std::vector<Vec3>& velocities, const std::vector<Vec3>& after) {
  double largest = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (std::ranges::count(scene.fixed, i) > 0) continue;
    const Vec3 preview = before[i] + kStep * velocities[i] + (kStep * kStep / 2) * scene.gravity;
    largest = std::max(largest, distance(preview, after[i]));
  }
  return largest;
}

/// Every step starts both from the reference's state.
void check_steps(const Case& c, const Settings& settings) {
  const SceneDescription& scene = c.scene.scene;
  Cloth scalar = cloth_of(scene, on(Backend::reference, settings));
  Cloth lanes = cloth_of(scene, on(Backend::simd, settings));
  double shortest = 1;
  for (const Constraint& constraint : scene.constraints) {
    shortest = std::min(shortest, constraint.rest_length);
  }
  int decided_otherwise = 0;
  for (int k = 0; k < c.steps; ++k) {
    CAPTURE(k);
    const std::vector<Vec3> before = positions(scalar), velocity = velocities(scalar);
    REQUIRE(lanes.write_positions(before));
    REQUIRE(lanes.write_velocities(velocity));
    const StepReport expected = step(scalar, kStep), found = step(lanes, kStep);
    REQUIRE(expected.status == Status::converged);
    REQUIRE(found.status == Status::converged);
    const std::vector<Vec3> after = positions(scalar);
    REQUIRE(max_strain(scene, positions(lanes)) <= c.tolerance * (1 + 1e-9));
    const double apart = largest_distance(after, positions(lanes));
    // Only the lanes' velocity loop looks at its result once more in double.
    const std::int64_t again = found.velocity_iterations - expected.velocity_iterations;
    const bool alike = found.iterations == expected.iterations && (again == 0 || again == 1) &&
                       found.corrections == expected.corrections;
    const double moved = largest_displacement(scene, before, velocity, after);
    const double rounding = kRounding * moved + 1e-15;
    const double speed = largest_distance(velocities(scalar), std::vector<Vec3>(after.size()));
    if (alike && apart <= rounding) {
      REQUIRE(found.direction_updates == expected.direction_updates);
      REQUIRE(largest_distance(velocities(lanes), velocities(scalar)) <=
              2 * rounding / kStep + (settings.velocity_correction ? kRounding * speed : 0));
      continue;
    }
    ++decided_otherwise;
    REQUIRE(apart <= 10 * c.tolerance * std::max(shortest, moved));
  }
  CHECK(decided_otherwise <= c.decided_otherwise);
}

void check_directions(const Case& c, bool velocity_correction) {
  for (const Directions directions : {Directions::each, Directions::frozen}) {
    CAPTURE(c.scene.name);
    CAPTURE(c.tolerance);
    CAPTURE(name(directions));
    CAPTURE(velocity_correction);
    Settings settings = paper_settings();
    settings.tolerance = c.tolerance;
    settings.measuring.directions = directions;
    settings.velocity_correction = velocity_correction;
    check_steps(c, settings);
  }
}

TEST_CASE("steps of built-in scenes are those of the reference, up to rounding") {
  for (const double tolerance : {0.1, 0.01, 0.001}) {
    check_directions({{"hang", scene_of("hang", 9)}, tolerance}, false);
  }
  check_directions({{"hang", scene_of("hang", 21)}}, false);
  check_directions({{"hang", scene_of("hang", 41)}, 0.01, 20}, false);
  check_directions({{"hang_sphere", scene_of("hang_sphere", 9)}, 0.01, 100}, false);
  check_directions({{"corners", scene_of("corners", 9)}, 0.01, 100}, false);
}

TEST_CASE("steps of ropes, hubs and random meshes are those of the reference, up to rounding") {
  check_directions({{"ropes", roped_sheet(9)}}, false);
  check_directions({{"ropes", roped_sheet(16)}, 0.01, 30}, false);
  check_directions({{"random mesh", random_sheet(9, 1)}}, false);
  check_directions({{"random mesh", random_sheet(15, 3)}, 0.01, 30, 1}, false);
  check_directions({{"hub", hub_sheet(9)}, 0.01, 30}, false);
}

TEST_CASE("steps over several tiles are those of the reference, up to rounding") {
  check_directions({{"hang", scene_of("hang", 66)}, 0.01, 8}, false);
  check_directions({{"ropes", roped_sheet(66)}, 0.01, 4}, false);
  REQUIRE(describe(*model_of(scene_of("hang", 66))).tiles > 1);
}

TEST_CASE("the velocity loop is that of the reference, up to rounding") {
  check_directions({{"hang", scene_of("hang", 9)}}, true);
  check_directions({{"corners", scene_of("corners", 9)}}, true);
  check_directions({{"random mesh", random_sheet(9, 1)}, 0.01, 60, 1}, true);  // one on SSE2
}

TEST_CASE("where an error lies on the edge of its tolerance the two part, and not by far") {
  check_directions({{"corners", scene_of("corners", 21)}, 0.01, 30, 2}, false);
  check_directions({{"random mesh", random_sheet(15, 2)}, 0.001, 20, 2}, false);
}

}  // namespace
}  // namespace weft::test::engine_step_backends
