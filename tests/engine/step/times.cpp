/// The times of a report: its stages, and contacts with bodies.
#include <doctest/doctest.h>

#include <chrono>
#include <numeric>
#include <vector>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/sheets.h"

namespace weft::test::engine_step_times {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_of_stages(const StepReport& report) {
  return std::accumulate(report.stage_seconds.begin(), report.stage_seconds.end(), 0.0);
}
double seconds(const StepReport& report, Stage stage) {
  return report.stage_seconds[static_cast<std::size_t>(stage)];
}
double sum(const ContactMs& ms) { return ms.find + ms.sweep + ms.verify; }

SceneDescription sheet_above_origin(std::uint32_t size) {
  MeshDescription mesh = quads(size);
  const double spacing = 0.5 / (size - 1);
  for (Vec3& v : mesh.positions) v = {spacing * v.x - 0.24, 0.103, spacing * v.y - 0.26};
  mesh.material = find_material("cotton").value();
  return made(mesh).scene;
}

struct Run {
  std::vector<StepReport> reports;
  double seconds = 0;  // by the clock of the caller
};

Run run_timed(Cloth& cloth, int steps) {
  Run run;
  for (int i = 0; i < steps; ++i) {
    const auto start = Clock::now();
    const auto report = cloth.step(1.0 / 60);
    run.seconds += std::chrono::duration<double>(Clock::now() - start).count();
    REQUIRE(report);
    run.reports.push_back(report.value());
  }
  return run;
}

void check_that_stages_add_up(const Run& run) {
  double counted = 0;
  for (const StepReport& report : run.reports) counted += seconds_of_stages(report);
  CHECK(counted <= run.seconds * (1 + 1e-9));
  CHECK(counted > 0.95 * run.seconds);
}

TEST_CASE("stages add up to the time of a step") {
  const Backend backend = each_backend();
  for (const Solver solver :
       {Solver::small_steps, Solver::yarn, Solver::gauss_seidel, Solver::direct}) {
    if (backend == Backend::reference && solver != Solver::small_steps) continue;
    CAPTURE(name(solver));
    for (const char* scene : {"hang", "hang_sphere"}) {
      CAPTURE(scene);
      Cloth cloth =
          cloth_of(scene_of(scene, 60), {.solver = solver, .backend = backend, .threads = 1});
      check_that_stages_add_up(run_timed(cloth, 5));
    }
  }
}

TEST_CASE("small steps find contacts with spheres in a stage of their own") {
  const Backend backend = each_backend();
  Cloth cloth = cloth_of(scene_of("hang_sphere", 15),
                         {.solver = Solver::small_steps, .backend = backend, .threads = 1});
  for (const StepReport& report : run_timed(cloth, 3).reports) {
    CHECK(seconds(report, Stage::find_contacts) > 0);
    CHECK(seconds(report, Stage::solve_positions) > 0);
    CHECK(report.contact_ms == ContactMs{});
  }
}

TEST_CASE("contacts with bodies have a time, and without bodies none") {
  const Backend backend = each_backend();
  const Settings settings{.solver = Solver::small_steps, .backend = backend, .threads = 1};
  const ShapeDescription mesh = icosphere(0.1, 2), ball = Ball{{0, 0, 0}, 0.1};
  for (const ShapeDescription* shape : {&mesh, &ball}) {
    CAPTURE(shape == &mesh);
    Cloth cloth = cloth_of(sheet_above_origin(10), settings);
    add(cloth, {.shape = shape_of(*shape)});
    const Run run = run_timed(cloth, 5);
    check_that_stages_add_up(run);
    for (const StepReport& report : run.reports) {
      CHECK(report.contact_ms.find > 0);
      CHECK(report.contact_ms.sweep > 0);
      CHECK(report.contact_ms.verify > 0);
      CHECK(sum(report.contact_ms) < 1e3 * seconds_of_stages(report));
      const double found = seconds(report, Stage::find_contacts);
      CHECK(found == doctest::Approx(1e-3 * report.contact_ms.find));
    }
  }
  Cloth alone = cloth_of(sheet_above_origin(10), settings);
  const StepReport report = run_timed(alone, 1).reports.front();
  CHECK(report.contact_ms == ContactMs{});
  CHECK(seconds(report, Stage::find_contacts) == 0);
}

}  // namespace
}  // namespace weft::test::engine_step_times
