/// Energy where a sheet meets a sphere. What a free fall is caught with within a step, g h^2 / 2
/// too deep, scheme paper turns into a speed g h / 2 too many: some 10^-3 J at h = 0.01, a quarter
/// of it with twice the substeps. More would come from errors that one solve leaves and the next
/// removes as a blow.
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/support/clothes.h"

namespace weft::test::engine_step_contact_energy {
namespace {

double largest_gain(const std::string& scene, const Settings& settings) {
  Cloth cloth = cloth_of(scene_of(scene, 20), settings);
  const double start = cloth.energy().total();
  double gain = 0;
  for (int k = 0; k < 120; ++k) {
    const StepReport report = step(cloth, 0.01);
    REQUIRE(report.status == Status::converged);
    CHECK(report.max_penetration <= settings.contact_tolerance * (1 + 1e-9));
    gain = std::max(gain, cloth.energy().total() - start);
  }
  return gain;
}

TEST_CASE("contacts bring in no more energy than the catch of a free fall") {
  for (const Solver solver : {Solver::direct, Solver::yarn}) {
    for (const int substeps : {1, 2, 4, 8}) {
      for (const double tolerance : {0.01, 0.0001}) {
        CAPTURE(name(solver));
        CAPTURE(substeps);
        CAPTURE(tolerance);
        Settings settings;
        settings.solver = solver;
        settings.substeps = substeps;
        settings.tolerance = tolerance;
        CHECK(largest_gain("sphere_drop", settings) < 2e-3 / (substeps * substeps));
        CHECK(largest_gain("hang_sphere", settings) < 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_step_contact_energy
