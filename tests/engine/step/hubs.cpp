/// Particles of many constraints: 65 is one more than a 64-bit mask has bits.
#include <doctest/doctest.h>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_hubs {
namespace {

/// One particle of 1 kg in the middle of `spokes` particles that weigh 1 kg together, each on a bar
/// of its own length, flying apart; every spoke is also tied to the next.
SceneDescription wheel(std::uint32_t spokes) {
  Random random(spokes);
  SceneDescription scene;
  scene.gravity = {0, 0, 0};
  scene.positions = {{0, 0, 0}};
  scene.velocities = {{0, 0, 0}};
  scene.masses = {1};
  for (std::uint32_t k = 1; k <= spokes; ++k) {
    scene.positions.push_back(random.in_box(1));
    scene.velocities.push_back(random.in_box(2));
    scene.masses.push_back(random.between(0.5, 1.5) / spokes);
    scene.constraints.push_back({0, k, length(scene.positions[k])});
    if (k % 2 == 0) {
      const double apart = distance(scene.positions[k - 1], scene.positions[k]);
      scene.constraints.push_back({k - 1, k, apart});
    }
  }
  return scene;
}

TEST_CASE("a hub of 65 and of 1,000 constraints works with every method, and all agree") {
  for (const std::uint32_t spokes : {65u, 1000u}) {
    const SceneDescription scene = wheel(spokes);
    for (const Directions directions : {Directions::each, Directions::frozen}) {
      std::vector<Vec3> first;
      for (const Method& method : kAllMethods) {
        if (method.directions != directions) continue;
        CAPTURE(spokes);
        CAPTURE(text(method));
        Cloth cloth = cloth_of(scene, with(tight(1e-6), method));
        for (int k = 0; k < 20; ++k) {
          const StepReport report = step(cloth, 0.01);
          REQUIRE(report.status == Status::converged);
          REQUIRE(report.corrections > 0);
          REQUIRE(max_strain(scene, positions(cloth)) <= 1e-6 * (1 + 1e-9));
        }
        if (first.empty()) first = positions(cloth);
        if (method.backend == Backend::reference) {
          CHECK(largest_distance(positions(cloth), first) < 1e-9);
        }
      }
    }
  }
}

TEST_CASE("skipping at a hub changes no bit") {
  for (const std::uint32_t spokes : {16u, 17u, 64u, 65u}) {
    for (std::size_t m = 0; m < kAllMethods.size(); m += 2) {
      CAPTURE(spokes);
      CAPTURE(text(kAllMethods[m]));
      Cloth all = cloth_of(wheel(spokes), with(tight(1e-6), kAllMethods[m]));
      Cloth skipping = cloth_of(wheel(spokes), with(tight(1e-6), kAllMethods[m + 1]));
      run(all, 0.01, 20);
      run(skipping, 0.01, 20);
      CHECK(all.state_hash() == skipping.state_hash());
    }
  }
}

TEST_CASE("a fixed hub holds its spokes") {
  SceneDescription scene = wheel(100);
  scene.fixed = {0};
  scene.gravity = {0, -10, 0};
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    Cloth cloth = cloth_of(scene, with(tight(1e-6), method));
    for (int k = 0; k < 20; ++k) REQUIRE(step(cloth, 0.01).status == Status::converged);
    CHECK(length(cloth.position(0)) == 0);
    CHECK(max_strain(scene, positions(cloth)) <= 1e-6 * (1 + 1e-9));
  }
}

TEST_CASE("what a hub moves is looked at again, whichever end of its constraints it is") {
  for (const bool first : {false, true}) {
    for (const bool anticipate : {false, true}) {
      CAPTURE(first);
      CAPTURE(anticipate);
      SceneDescription scene = scene_of("hang", 20);
      scene.gravity = {0, 0, 0};  // the hub alone sets things going
      const auto hub = static_cast<std::uint32_t>(scene.positions.size());
      scene.positions.push_back(scene.positions[399]);
      scene.positions[hub].z += 0.3;
      scene.masses.push_back(1);
      scene.spheres = {hub};
      scene.velocities.resize(hub + 1);
      scene.velocities[hub] = {0, 0, 5};
      scene.radii.assign(hub + 1, 0);
      scene.radii[hub] = 0.01;
      scene.constraints.push_back({first ? hub : 399, first ? 399 : hub, 0.3});
      Settings settings = paper_settings();
      settings.measuring.anticipate = anticipate;
      settings.measuring.skip = false;
      Cloth all = cloth_of(scene, settings);
      settings.measuring.skip = true;
      Cloth skipping = cloth_of(scene, settings);
      run(all, 0.01, 10);
      run(skipping, 0.01, 10);
      CHECK(skipping.state_hash() == all.state_hash());
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_step_hubs
