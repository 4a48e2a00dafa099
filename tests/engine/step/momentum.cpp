/// What the two impulse loops conserve. Impulses come in opposite pairs, so linear momentum is kept
/// by both, always. Along a pair's line they exert no torque either. The scheme applies the
/// impulses of the position loop along the directions of the *previewed* positions, so what is kept
/// is the angular momentum about those: with x = p + h v the preview, sum m x cross v is the same
/// before and after a loop that never renews its directions. (About the committed positions it is
/// not: with u the displacements it changes by sum m u cross v. That is the scheme's own error.)
/// The velocity loop works along the directions of the committed positions, and keeps the true one.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_momentum {
namespace {

constexpr double kStep = 0.01;
constexpr int kSize = 8;
// A displacement is known to an ulp of a position, 1e-16 m, and so its velocity to 1e-14 m/s: if 64
// particles of at most 2 kg, at most 1 m away, all round the same way, to this much, kg m^2 / s.
constexpr double kRounding = 64 * 2 * 1 * 1e-14;

/// What so many corrections may lose: in floats each rounds off some of the momentum that it moves,
/// about 1 kg m/s here, in no common direction.
double lost(Backend backend, std::int64_t corrections) {
  return exactness(backend, kRounding, std::sqrt(static_cast<double>(corrections)));
}

Settings fixed_iterations(const Method& method, int iterations) {
  Settings settings = with(paper_settings(), method);
  settings.iterations = iterations;
  return settings;
}

TEST_CASE("linear momentum is kept by both loops over many steps") {
  const SceneDescription scene = drifting_sheet(kSize, 1);
  const Vec3 start = momentum(scene.masses, scene.velocities);
  for (const Method& method : kAllMethods) {
    for (const bool velocity_correction : {false, true}) {
      CAPTURE(text(method));
      CAPTURE(velocity_correction);
      Settings settings = with(paper_settings(), method);
      settings.velocity_correction = velocity_correction;
      Cloth cloth = cloth_of(scene, settings);
      std::int64_t corrections = 0;
      for (int k = 0; k < 100; ++k) {
        corrections += step(cloth, kStep).corrections;
        REQUIRE(corrections > k);
        REQUIRE(distance(momentum(scene.masses, velocities(cloth)), start) <
                10 * lost(method.backend, corrections));
      }
    }
  }
}

TEST_CASE("the centre of mass of a free sheet drifts along a straight line") {
  const Backend backend = each_backend();
  const SceneDescription scene = drifting_sheet(kSize, 2);
  Cloth cloth = cloth_of(scene, on(backend));
  std::int64_t corrections = 0;
  for (int k = 0; k < 100; ++k) corrections += step(cloth, kStep).corrections;
  const Vec3 start = momentum(scene.masses, scene.positions);
  const Vec3 drift = momentum(scene.masses, scene.velocities);
  CHECK(distance(momentum(scene.masses, positions(cloth)), start + 100 * kStep * drift) <
        10 * lost(backend, corrections));
}

TEST_CASE("the position loop keeps angular momentum about the previewed positions") {
  const SceneDescription scene = drifting_sheet(kSize, 3);
  std::vector<Vec3> preview;
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    preview.push_back(scene.positions[i] + kStep * scene.velocities[i]);
  }
  const Vec3 before = angular_momentum(scene.masses, preview, scene.velocities);
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    // Directions that are renewed before each iteration are the preview's in the first one alone.
    const int iterations = method.directions == Directions::frozen ? 20 : 1;
    Cloth cloth = cloth_of(scene, fixed_iterations(method, iterations));
    const StepReport report = step(cloth, kStep);
    CHECK(report.direction_updates == 1);
    CHECK(report.corrections > 0);
    const Vec3 after = angular_momentum(scene.masses, preview, velocities(cloth));
    CHECK(distance(after, before) < lost(method.backend, report.corrections));
  }
}

TEST_CASE("without forces, angular momentum changes by sum m u cross v and no more") {
  const SceneDescription scene = drifting_sheet(kSize, 4);
  const Backend backend = each_backend();
  Cloth cloth = cloth_of(scene, on(backend, fixed_iterations(kMethods[4], 20)));
  const StepReport report = step(cloth, kStep);
  const std::vector<Vec3> after = positions(cloth);
  std::vector<Vec3> moved;
  for (std::size_t i = 0; i < after.size(); ++i) {
    moved.push_back(after[i] - scene.positions[i] - kStep * scene.velocities[i]);
  }
  const Vec3 change = angular_momentum(scene.masses, after, velocities(cloth)) -
                      angular_momentum(scene.masses, scene.positions, scene.velocities);
  const Vec3 predicted = angular_momentum(scene.masses, moved, scene.velocities);
  CHECK(length(predicted) > 1e-6);
  CHECK(distance(change, predicted) < lost(backend, report.corrections));
}

TEST_CASE("the velocity loop keeps momentum and angular momentum at the committed positions") {
  const SceneDescription scene = drifting_sheet(kSize, 5);
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    Settings settings = with(paper_settings(), method);
    Cloth without = cloth_of(scene, settings);
    settings.velocity_correction = true;
    settings.velocity_tolerance = 1e-6;
    Cloth corrected = cloth_of(scene, settings);
    step(without, kStep);
    const StepReport report = step(corrected, kStep);
    CHECK(report.velocity_iterations > 1);
    const std::vector<Vec3> place = positions(without);
    CHECK(largest_distance(place, positions(corrected)) == 0);
    const std::vector<Vec3> before = velocities(without);
    const std::vector<Vec3> after = velocities(corrected);
    CHECK(largest_distance(before, after) > 0.01);
    CHECK(distance(momentum(scene.masses, after), momentum(scene.masses, before)) <
          lost(method.backend, report.corrections));
    CHECK(distance(angular_momentum(scene.masses, place, after),
                   angular_momentum(scene.masses, place, before)) <
          lost(method.backend, report.corrections));
  }
}

TEST_CASE("the velocity loop leaves no constraint's ends approaching or parting") {
  const SceneDescription scene = drifting_sheet(kSize, 6);
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    Settings settings = with(paper_settings(), method);
    settings.velocity_correction = true;
    settings.velocity_tolerance = 1e-7;
    Cloth cloth = cloth_of(scene, settings);
    CHECK(step(cloth, kStep).status == Status::converged);
    const std::vector<Vec3> p = positions(cloth);
    const std::vector<Vec3> v = velocities(cloth);
    for (const Constraint& c : scene.constraints) {
      const Vec3 bar = p[c.a] - p[c.b];
      REQUIRE(std::abs(dot(bar, v[c.a] - v[c.b]) / length(bar)) <= 1e-7 * (1 + 1e-6));
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_step_momentum
