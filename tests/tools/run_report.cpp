#include "tools/run_report.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

namespace weft::tools {
namespace {

/// Figures that are all different.
RunReport report() {
  RunReport report;
  report.scene = "somewhere";
  report.plan.dt = 0.01;
  RunSummary& summary = report.summary;
  summary.frames = 4;
  summary.threads = 3;
  summary.step_seconds = 0.008;
  summary.longest_step_seconds = 0.0035;
  summary.substeps = 6;
  summary.iterations = 20;
  summary.velocity_iterations = 12;
  summary.direction_updates = 28;
  summary.model.particles = 1;
  return report;
}

TEST_CASE("figures are given per frame, and time beside the time that passes in the scene") {
  const Json json = to_json(report());
  CHECK(json["ms_per_frame"] == doctest::Approx(2));
  CHECK(json["max_ms_per_frame"] == doctest::Approx(3.5));
  CHECK(json["real_time_factor"] == doctest::Approx(5));
  CHECK(json["iterations_per_step"] == 5);
  CHECK(json["velocity_iterations_per_step"] == 3);
  CHECK(json["direction_updates_per_step"] == 7);
}

TEST_CASE("substeps are those asked for, or the mean of those chosen") {
  RunReport asked = report();
  asked.settings.substeps = 8;
  CHECK(to_json(asked)["substeps"] == 8);
  asked.settings.substeps = kAutomaticSubsteps;
  CHECK(to_json(asked)["substeps"] == 1.5);
}

TEST_CASE("the reference backend is scalar and has one thread") {
  RunReport on_reference = report();
  on_reference.summary.isa = Isa::avx2;
  CHECK(to_json(on_reference)["threads"] == 3);
  CHECK(to_json(on_reference)["isa"] == "avx2");
  on_reference.settings.backend = Backend::reference;
  CHECK(to_json(on_reference)["threads"] == 1);
  CHECK(to_json(on_reference)["isa"] == "scalar");
}

TEST_CASE("a table says which solver was chosen, and of contacts where there are spheres") {
  RunReport chosen = report();
  chosen.settings.solver = Solver::automatic;
  chosen.summary.solver = Solver::yarn;
  CHECK(to_table(chosen).find("auto (yarn)") != std::string::npos);
  CHECK(to_table(chosen).find("deepest penetration") == std::string::npos);
  chosen.summary.model.spheres = 1;
  chosen.settings.solver = Solver::direct;
  chosen.settings.iterations = 3;
  CHECK(to_table(chosen).find("auto") == std::string::npos);
  CHECK(to_table(chosen).find("3 iterations per substep") != std::string::npos);
  CHECK(to_table(chosen).find("deepest penetration") != std::string::npos);
}

}  // namespace
}  // namespace weft::tools
