/// The paper's claims about its optimisations: 4.2 and 4.3 do not change what is simulated, and 4.4
/// still ends with every true error within tolerance.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_methods {
namespace {

constexpr double kStep = 0.01;
constexpr int kSteps = 200;

struct Case {
  const char* scene;
  int size;
};
constexpr Case kCases[]{{"hang", 8}, {"hang_sphere", 9}, {"sphere_drop", 8}};

struct Motion {
  std::vector<Vec3> positions;
  std::vector<Vec3> velocities;
  std::uint64_t hash = 0;
  std::int64_t visits = 0;
  std::int64_t corrections = 0;
  std::int64_t iterations = 0;
};

Motion simulate(const SceneDescription& scene, const Settings& settings, int steps = kSteps) {
  Cloth cloth = cloth_of(scene, settings);
  Motion motion;
  for (int k = 0; k < steps; ++k) {
    const StepReport report = step(cloth, kStep);
    REQUIRE(report.status == Status::converged);
    motion.visits += report.visits;
    motion.corrections += report.corrections;
    motion.iterations += report.iterations + report.velocity_iterations;
  }
  motion.positions = positions(cloth);
  motion.velocities = velocities(cloth);
  motion.hash = cloth.state_hash();
  return motion;
}

/// f(scene, settings) for every scene, directions, and velocity correction.
template <class F>
void for_every_setting(Backend backend, F f) {
  for (const Case& c : kCases) {
    const SceneDescription scene = scene_of(c.scene, c.size);
    for (const Directions directions : {Directions::each, Directions::frozen}) {
      for (const bool velocity_correction : {false, true}) {
        const std::string setting = std::string(c.scene) + ", " + std::string(name(directions)) +
                                    (velocity_correction ? ", velocity correction" : "");
        CAPTURE(setting);
        Settings settings = on(backend);
        settings.measuring.directions = directions;
        settings.velocity_correction = velocity_correction;
        f(scene, settings);
      }
    }
  }
}

TEST_CASE("skipping satisfied constraints changes no bit of 200 steps") {
  for_every_setting(each_backend(), [](const SceneDescription& scene, Settings settings) {
    for (const bool anticipate : {false, true}) {
      CAPTURE(anticipate);
      settings.measuring.anticipate = anticipate;
      settings.measuring.skip = false;
      const Motion all = simulate(scene, settings);
      settings.measuring.skip = true;
      const Motion skipped = simulate(scene, settings);
      CHECK(skipped.hash == all.hash);
      CHECK(largest_distance(skipped.positions, all.positions) == 0);
      CHECK(largest_distance(skipped.velocities, all.velocities) == 0);
      CHECK(skipped.corrections == all.corrections);
      CHECK(skipped.iterations == all.iterations);
      CHECK(skipped.visits <= all.visits);
      // So small a sheet is one chunk per colour on the simd backend: it may pass over nothing.
      const bool scalar = settings.backend == Backend::reference;
      if (scalar && settings.measuring.directions == Directions::frozen)
        CHECK(skipped.visits < all.visits);
    }
  });
}

TEST_CASE("anticipating errors changes none of 200 steps beyond rounding") {
  for_every_setting(Backend::reference, [](const SceneDescription& scene, Settings settings) {
    settings.measuring.anticipate = false;
    Cloth recomputed = cloth_of(scene, settings);
    settings.measuring.anticipate = true;
    Cloth anticipated = cloth_of(scene, settings);
    for (int k = 0; k < kSteps; ++k) {
      REQUIRE(anticipated.write_positions(positions(recomputed)));
      REQUIRE(anticipated.write_velocities(velocities(recomputed)));
      const StepReport expected = step(recomputed, kStep);
      const StepReport report = step(anticipated, kStep);
      REQUIRE(largest_distance(positions(anticipated), positions(recomputed)) < 1e-13);
      REQUIRE(largest_distance(velocities(anticipated), velocities(recomputed)) < 1e-11);
      REQUIRE(report.iterations == expected.iterations);
      REQUIRE(report.velocity_iterations == expected.velocity_iterations);
      REQUIRE(report.corrections == expected.corrections);
    }
  });
}

/// The same run, but one particle starts 1e-15 m lower: how far rounding alone may lead.
Motion simulate_twin(SceneDescription scene, const Settings& settings) {
  scene.positions[30].y -= 1e-15;
  return simulate(scene, settings);
}

TEST_CASE("anticipating errors does not change a run of 200 steps") {
  for_every_setting(Backend::reference, [](const SceneDescription& scene, Settings settings) {
    settings.measuring.anticipate = false;
    const Motion recomputed = simulate(scene, settings);
    const Motion twin = simulate_twin(scene, settings);
    settings.measuring.anticipate = true;
    const Motion anticipated = simulate(scene, settings);
    // A sheet that buckles under a sphere amplifies rounding a billion times in 2 s.
    const double chaos = largest_distance(twin.positions, recomputed.positions);
    CHECK(largest_distance(anticipated.positions, recomputed.positions) <
          std::max(1e-9, 10 * chaos));
    CHECK(chaos < 1e-5);
    CHECK(anticipated.iterations == recomputed.iterations);
    CHECK(anticipated.corrections == recomputed.corrections);
  });
}

TEST_CASE("every method ends every step with every true error within tolerance") {
  for (const Case& c : kCases) {
    const SceneDescription scene = scene_of(c.scene, c.size);
    for (const Method& method : kAllMethods) {
      CAPTURE(std::string(c.scene));
      CAPTURE(text(method));
      Settings settings = with(paper_settings(), method);
      settings.tolerance = 0.002;
      Cloth cloth = cloth_of(scene, settings);
      for (int k = 0; k < kSteps; ++k) {
        const StepReport report = step(cloth, kStep);
        REQUIRE(report.status == Status::converged);
        const std::vector<Vec3> now = positions(cloth);
        REQUIRE(max_strain(scene, now) <= 0.002 * (1 + 1e-9));
        REQUIRE(max_penetration(scene, now) <= 1e-4 * (1 + 1e-9));
      }
    }
  }
}

TEST_CASE("at full size, at the paper's tolerances: skipping changes no bit" *
          doctest::test_suite("slow")) {
  for (const char* scene_name : {"hang", "hang_sphere"}) {
    for (const double tolerance : {0.1, 0.01, 1e-5}) {
      for (std::size_t m = 0; m < kAllMethods.size(); m += 2) {
        CAPTURE(std::string(scene_name));
        CAPTURE(tolerance);
        CAPTURE(text(kAllMethods[m]));
        Settings settings = paper_settings();
        settings.tolerance = tolerance;
        const SceneDescription scene = scene_of(scene_name, 20);
        const Motion all = simulate(scene, with(settings, kAllMethods[m]), 50);
        const Motion skipped = simulate(scene, with(settings, kAllMethods[m + 1]), 50);
        CHECK(skipped.hash == all.hash);
        CHECK(skipped.corrections == all.corrections);
        CHECK(max_strain(scene, skipped.positions) <= tolerance * (1 + 1e-9));
      }
    }
  }
}

TEST_CASE("a chain whose end weighs as much as 10,000 links stays within tolerance" *
          doctest::test_suite("slow")) {
  const auto scene = scenes::make("chain", {.size = 20, .end_mass = 1e4});
  REQUIRE(scene);
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    const Motion motion = simulate(scene.value(), with(paper_settings(), method), 10);
    CHECK(max_strain(scene.value(), motion.positions) <= 0.01 * (1 + 1e-9));
  }
}

TEST_CASE("frozen directions live for as many iterations as the settings say") {
  const Backend backend = each_backend();
  const SceneDescription scene = scene_of("hang", 12);
  Settings settings = on(backend);
  settings.tolerance = 0.001;
  settings.measuring.skip = settings.measuring.anticipate = false;
  settings.measuring.directions = Directions::each;
  const Motion each = simulate(scene, settings, 40);
  settings.measuring.directions = Directions::frozen;
  settings.measuring.renew_after = 1;
  CHECK(simulate(scene, settings, 40).hash == each.hash);
  for (const int most : {2, 5, 32}) {
    CAPTURE(most);
    settings.measuring.renew_after = most;
    Cloth cloth = cloth_of(scene, settings);
    for (int k = 0; k < 40; ++k) {
      const StepReport report = step(cloth, kStep);
      REQUIRE(report.iterations <= most * report.direction_updates);
    }
  }
  settings.measuring.renew_after = 0;
  Cloth paper = cloth_of(scene, settings);
  std::int64_t longest = 0;
  for (int k = 0; k < 40; ++k) {
    const StepReport report = step(paper, kStep);
    longest = std::max(longest, report.iterations / report.direction_updates);
  }
  CHECK(longest > 32);
}

TEST_CASE("in lanes directions that nothing renews are renewed after 1024 iterations") {
  const auto end = [](int renew_after) {
    Settings settings = paper_settings();
    settings.tolerance = 1e-5;
    settings.measuring.renew_after = renew_after;
    Cloth cloth = cloth_of(scene_of("chain", 40), settings);
    run(cloth, kStep, 2);
    return cloth.state_hash();
  };
  CHECK(end(0) == end(1024));
  CHECK(end(0) != end(4000));
}

TEST_CASE("renewed and frozen directions tend to the same motion as dt does to 0") {
  const Backend backend = each_backend();
  const SceneDescription scene = scene_of("hang", 5);
  double before = 0;
  for (const int steps : {10, 20, 40, 80}) {
    std::vector<Vec3> ends[2];
    for (const Directions directions : {Directions::each, Directions::frozen}) {
      Settings settings = on(backend, tight(1e-10));
      settings.measuring.directions = directions;
      Cloth cloth = cloth_of(scene, settings);
      run(cloth, 0.2 / steps, steps);
      ends[directions == Directions::each] = positions(cloth);
    }
    const double apart = largest_distance(ends[0], ends[1]);
    if (steps > 10) CHECK(apart < 0.6 * before);
    before = apart;
  }
  CHECK(before > 0);
  CHECK(before < 1e-3);
}

}  // namespace
}  // namespace weft::test::engine_step_methods
