/// Everything in one scene: bars, ropes, a hub, a fixed and a free sphere, unequal masses, forces.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_mixed {
namespace {

constexpr int kSize = 7;

/// A sheet whose diagonals are ropes, pinned at two corners, its middle roped to all of the border
/// (a hub), one sphere to fall on and one that falls.
SceneDescription mixed_scene() {
  Random random(31);
  SceneDescription scene = drifting_sheet(kSize, 32);
  scene.gravity = {0, -10, 0};
  const auto number = [](int i, int j) { return static_cast<std::uint32_t>(i * kSize + j); };
  for (int i = 0; i + 1 < kSize; ++i) {
    for (int j = 0; j + 1 < kSize; ++j) {
      scene.constraints.push_back(
          {number(i, j), number(i + 1, j + 1), 0.1 * std::sqrt(2.0), ConstraintKind::rope});
    }
  }
  scene.fixed = {number(0, 0), number(0, kSize - 1)};
  const std::uint32_t middle = number(kSize / 2, kSize / 2);
  for (int k = 0; k + 1 < kSize; ++k) {
    for (const std::uint32_t border :
         {number(0, k), number(k, kSize - 1), number(kSize - 1, k + 1), number(k + 1, 0)}) {
      const double reach = 1.05 * distance(scene.positions[middle], scene.positions[border]);
      scene.constraints.push_back({middle, border, reach, ConstraintKind::rope});
    }
  }
  scene.radii.assign(scene.positions.size(), 0.005);
  for (const double y : {-0.2, 0.2}) {
    scene.spheres.push_back(static_cast<std::uint32_t>(scene.positions.size()));
    scene.positions.push_back({0.3, y, 0.33});
    scene.velocities.push_back({0, -1, 0});
    scene.masses.push_back(3);
    scene.radii.push_back(0.1);
  }
  scene.fixed.push_back(scene.spheres[0]);
  return scene;
}

struct Run {
  std::vector<Vec3> positions;
  std::uint64_t hash = 0;
  int most_contacts = 0;
  std::int64_t visits = 0;
};

Run simulate(const SceneDescription& scene, const Settings& settings, int steps) {
  Cloth cloth = cloth_of(scene, settings);
  Run run;
  for (int k = 0; k < steps; ++k) {
    const StepReport report = step(cloth, 0.002);
    REQUIRE(report.status == Status::converged);
    const std::vector<Vec3> now = positions(cloth);
    REQUIRE(max_strain(scene, now) <= settings.tolerance * (1 + 1e-9));
    REQUIRE(max_penetration(scene, now) <= settings.contact_tolerance * (1 + 1e-9));
    run.most_contacts = std::max(run.most_contacts, report.contacts);
    run.visits += report.visits;
  }
  run.positions = positions(cloth);
  run.hash = cloth.state_hash();
  return run;
}

TEST_CASE("ropes, bars and contacts together: 4.2 and 4.3 change nothing") {
  const SceneDescription scene = mixed_scene();
  REQUIRE(describe(*model_of(scene)).ropes > 50);
  for (const bool velocity_correction : {false, true}) {
    for (std::size_t base = 0; base < kAllMethods.size(); base += 4) {
      Settings settings = paper_settings();
      settings.tolerance = 1e-4;
      settings.velocity_correction = velocity_correction;
      Run runs[4];
      for (std::size_t m = 0; m < 4; ++m) {
        CAPTURE(text(kAllMethods[base + m]));
        CAPTURE(velocity_correction);
        runs[m] = simulate(scene, with(settings, kAllMethods[base + m]), 70);
        CHECK(runs[m].most_contacts > 3);
        CHECK(largest_distance(runs[m].positions, runs[0].positions) < 1e-9);
      }
      CHECK(runs[1].hash == runs[0].hash);
      CHECK(runs[3].hash == runs[2].hash);
      CHECK(runs[1].visits < runs[0].visits);
      CHECK(runs[3].visits < runs[2].visits);
      if (kAllMethods[base].backend == Backend::simd) CHECK(runs[2].hash == runs[0].hash);
    }
  }
}

TEST_CASE("ropes, bars and contacts together: all eight methods tend to one motion") {
  const SceneDescription scene = mixed_scene();
  std::vector<Vec3> first;
  for (const Method& method : kAllMethods) {
    // On the simd backend methods differ in what they pass over, not in what they do.
    if (method.backend == Backend::simd && !(method.anticipate && method.skip)) continue;
    CAPTURE(text(method));
    Settings settings = with(paper_settings(), method);
    settings.tolerance = 1e-5;
    settings.contact_tolerance = 1e-6;
    const Run run = simulate(scene, settings, 12);
    if (first.empty()) first = run.positions;
    CHECK(largest_distance(run.positions, first) < 1e-3);
  }
}

}  // namespace
}  // namespace weft::test::engine_step_mixed
