/// A report says what the state is, not what the solver hoped for.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/clothes.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/motion.h"

namespace weft::test::engine_step_reports {
namespace {

void check_strain(const SceneDescription& scene, const Cloth& cloth, double max, double rms,
                  std::uint32_t worst) {
  const std::vector<double> expected = strains(scene, positions(cloth));
  double largest = 0;
  double squares = 0;
  for (const double strain : expected) {
    largest = std::max(largest, strain);
    squares += strain * strain;
  }
  REQUIRE(max == doctest::Approx(largest).epsilon(1e-12));
  REQUIRE(rms ==
          doctest::Approx(std::sqrt(squares / static_cast<double>(expected.size()))).epsilon(1e-9));
  REQUIRE(worst < expected.size());
  REQUIRE(expected[worst] == doctest::Approx(largest).epsilon(1e-9));
}

TEST_CASE("the reported strain is that of the positions one can read") {
  const Backend backend = each_backend();
  std::vector<NamedScene> scenes{
      {"ropes", roped_sheet(9)}, {"random mesh", random_sheet(9, 4)}, {"hub", hub_sheet(9)}};
  for (const char* name : {"hang", "hang_sphere", "sphere_drop", "corners"}) {
    scenes.push_back({name, scene_of(name, 9)});
  }
  for (const auto& [name, scene] : scenes) {
    CAPTURE(name);
    for (const int iterations : {0, 2}) {
      Settings settings = on(backend);
      settings.iterations = iterations;
      Cloth cloth = cloth_of(scene, settings);
      for (int k = 0; k < 60; ++k) {
        const StepReport report = step(cloth, 0.01);
        check_strain(scene, cloth, report.max_strain, report.rms_strain, report.worst_constraint);
        const Strain strain = cloth.strain();
        check_strain(scene, cloth, strain.max, strain.rms, strain.worst_constraint);
      }
    }
  }
}

TEST_CASE("a step out of reach of its tolerance reports the strain that is left") {
  const Backend backend = each_backend();
  Settings settings = on(backend, tight(1e-9));
  settings.max_iterations = 2;
  const SceneDescription scene = scene_of("hang", 9);
  Cloth cloth = cloth_of(scene, settings);
  const StepReport report = step(cloth, 0.01);
  CHECK(report.status == Status::iteration_limit);
  check_strain(scene, cloth, report.max_strain, report.rms_strain, report.worst_constraint);
}

TEST_CASE("counts stand in a sane relation") {
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    const SceneDescription scene = scene_of("hang", 9);
    const auto constraints = static_cast<std::int64_t>(scene.constraints.size());
    Cloth cloth = cloth_of(scene, with(paper_settings(), method));
    for (int k = 0; k < 60; ++k) {
      const StepReport report = step(cloth, 0.01);
      REQUIRE(report.iterations >= 1);
      REQUIRE(report.direction_updates >= 1);
      REQUIRE(report.direction_updates <= report.iterations);
      REQUIRE(report.corrections <= report.visits);
      REQUIRE(report.visits <= report.iterations * constraints);
      if (!method.skip) REQUIRE(report.visits == report.iterations * constraints);
      if (method.directions == Directions::each) {
        REQUIRE(report.direction_updates == report.iterations);
      }
      REQUIRE(report.velocity_iterations == 0);
      REQUIRE(report.contacts == 0);
    }
  }
}

TEST_CASE("only the stages that a scene needs take time") {
  const Backend backend = each_backend();
  const auto seconds = [](const StepReport& report, Stage stage) {
    return report.stage_seconds[static_cast<std::size_t>(stage)];
  };
  Cloth plain = cloth_of(scene_of("hang", 9), on(backend));
  const StepReport lean = step(plain, 0.01);
  CHECK(seconds(lean, Stage::find_contacts) == 0);
  CHECK(seconds(lean, Stage::correct_velocities) == 0);
  CHECK(seconds(lean, Stage::solve_positions) > 0);

  Settings settings = on(backend);
  settings.velocity_correction = true;
  Cloth full = cloth_of(scene_of("hang_sphere", 9), settings);
  const StepReport report = step(full, 0.01);
  for (const double stage : report.stage_seconds) CHECK(stage > 0);
}

TEST_CASE("a scene without constraints converges at once and names no worst constraint") {
  const Backend backend = each_backend();
  SceneDescription scene;
  scene.positions = {{0, 0, 0}};
  scene.masses = {1};
  Cloth cloth = cloth_of(scene, on(backend));
  const StepReport report = step(cloth, 0.01);
  CHECK(report.status == Status::converged);
  CHECK(report.worst_constraint == kNoIndex);
  CHECK(report.max_strain == 0);
  CHECK(report.visits == 0);
}

}  // namespace
}  // namespace weft::test::engine_step_reports
