/// Steps in which a solver gives up: large sheets between corners, at loose tolerances, where what
/// one step leaves is in the next one's way.
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/support/clothes.h"

namespace weft::test {
namespace {

struct Run {
  int halvings = 0, iterations = 0;  // largest of a step
  double energy_gain = 0;
};

Run run(int size, double tolerance, int steps) {
  Settings settings;
  settings.tolerance = tolerance;
  Cloth cloth = cloth_of(scene_of("corners", size), settings);
  const double start = cloth.energy().total();
  Run run;
  for (int k = 0; k < steps; ++k) {
    const StepReport report = step(cloth, 0.01);
    REQUIRE(report.status == Status::converged);
    CHECK(report.max_strain <= tolerance);
    run.halvings = std::max(run.halvings, report.halvings);
    run.iterations = std::max(run.iterations, report.iterations);
    run.energy_gain = std::max(run.energy_gain, cloth.energy().total() - start);
  }
  return run;
}

TEST_CASE("trouble passes: it never comes to thousands of sweeps, and brings in no energy") {
  for (const double tolerance : {0.01, 0.003}) {
    CAPTURE(tolerance);
    const Run done = run(101, tolerance, 40);
    CHECK(done.halvings > 0);
    CHECK(done.iterations < 3000);
    CHECK(done.energy_gain < 1e-5);
  }
}

}  // namespace
}  // namespace weft::test
