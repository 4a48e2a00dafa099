/// What bounds a step by small steps: n given substeps are n sweeps, and max_iterations the visits
/// beyond, whatever the state.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_budget {
namespace {

constexpr double kFrame = 1. / 60;
constexpr std::uint32_t kSize = 12;

/// A sheet that hangs on two corners, with all that makes steps hard done to it in turns.
struct Trouble {
  std::string name;
  SceneDescription scene;
  std::function<void(Cloth& cloth, int frame)> disturb = [](Cloth&, int) {};
};

SceneDescription hanging_sheet(Cut cut, bool is_cotton) {
  MeshDescription mesh = sheet(
      kSize, kSize,
      [](double i, double j) {
        return Vec3{0.05 * j, -0.05 * i, 0.01 * std::sin(i + 2 * j)};
      },
      [cut](auto, auto) { return cut; });
  mesh.pins = {0, kSize - 1};
  if (is_cotton)
    mesh.material = find_material("cotton").value();
  else
    mesh.mass = 0.1;
  return made(mesh).scene;
}

void move_pin(Cloth& cloth, std::uint32_t pin, Vec3 by) {
  REQUIRE(cloth.move_fixed(pin, cloth.position(pin) + by));
}

std::vector<Trouble> troubles() {
  std::vector<Trouble> all;
  for (const auto& [name, cut, is_cotton] :
       {std::tuple{"quads", Cut::none, false}, std::tuple{"triangles", Cut::first, false},
        std::tuple{"cotton", Cut::first, true}}) {
    const SceneDescription scene = hanging_sheet(cut, is_cotton);
    all.push_back({std::string(name) + " that swing", scene});
    all.push_back({std::string(name) + " whose pins part", scene, [](Cloth& cloth, int) {
                     move_pin(cloth, 0, {-0.05, 0, 0});
                   }});
    all.push_back(
        {std::string(name) + " whose pins are shaken", scene, [](Cloth& cloth, int frame) {
           const double way = frame % 4 < 2 ? 0.2 : -0.2;
           move_pin(cloth, 0, {way, way, 0});
           move_pin(cloth, kSize - 1, {way, way, 0});
         }});
    all.push_back({std::string(name) + " that are put out of shape", scene, [](Cloth& cloth, int) {
                     std::vector<Vec3> x = positions(cloth);
                     for (Vec3& p : x) p = 1.3 * p;
                     REQUIRE(cloth.write_positions(x));
                   }});
    Trouble spheres{std::string(name) + " under spheres", scene};
    for (int i = 0; i < 3; ++i) {
      spheres.scene.spheres.push_back(static_cast<std::uint32_t>(spheres.scene.positions.size()));
      spheres.scene.fixed.push_back(spheres.scene.spheres.back());
      spheres.scene.positions.push_back({0.1 + 0.2 * i, -0.3, 0});
      spheres.scene.masses.push_back(1);
    }
    spheres.scene.radii.assign(spheres.scene.positions.size(), 0);
    for (const std::uint32_t i : spheres.scene.spheres) spheres.scene.radii[i] = 0.15;
    all.push_back(spheres);
  }
  return all;
}

void check_budget(const Trouble& trouble, const Settings& settings) {
  const int n = settings.substeps, m = settings.max_iterations;
  Cloth cloth = cloth_of(trouble.scene, settings);
  const ModelInfo info = describe(*cloth.model());
  const auto constraints = static_cast<std::int64_t>(info.constraints + info.membrane_elements);
  for (int frame = 0; frame < 8; ++frame) {
    CAPTURE(frame);
    trouble.disturb(cloth, frame);
    const StepReport report = step(cloth, kFrame);
    // Contacts are visited once in each substep, and counted where a pass visits them again.
    const std::int64_t pairs = static_cast<std::int64_t>(cloth.particle_count()) * 3;
    CHECK(report.substeps == n);
    CHECK(report.iterations >= n);
    CHECK(report.iterations <= n + m);
    CHECK(report.visits <= (n + m) * (constraints + pairs));
    if (m == 0) CHECK(report.iterations == n);
    if (m == 0 && trouble.scene.spheres.empty()) CHECK(report.visits == n * constraints);
    const bool is_right = report.max_error <= settings.tolerance &&
                          report.max_penetration <= settings.contact_tolerance;
    if (report.status <= Status::infeasible)
      CHECK(is_right == (report.status == Status::converged));
  }
}

TEST_CASE("a step does its substeps' sweeps and no more than max_iterations beyond") {
  const Backend backend = each_backend();
  for (const Trouble& trouble : troubles()) {
    for (const int substeps : {1, 4, 8}) {
      for (const int most : {0, 1, 3, 20, 1000}) {
        CAPTURE(trouble.name);
        CAPTURE(substeps);
        CAPTURE(most);
        check_budget(trouble, {.substeps = substeps,
                               .max_iterations = most,
                               .solver = Solver::small_steps,
                               .backend = backend,
                               .threads = 1});
      }
    }
  }
}

TEST_CASE("fewer substeps than are needed take little more work than automatic ones") {
  MeshDescription mesh = sheet(
      31, 31,
      [](double i, double j) {
        return Vec3{(i + 0.2 * std::sin(7 * i + 3 * j)) / 30, 0, j / 30};  // no woven cells
      },
      [](auto i, auto j) { return (i + j) % 2 == 0 ? Cut::first : Cut::second; });
  mesh.pins = {0, 30};
  mesh.material = find_material("cotton").value();
  const SceneDescription scene = made(mesh).scene;
  // In sweeps: local passes take twenty times as long for a triangle.
  constexpr double kLocalVisit = 20, kMost = 1.4;
  const auto work = [&](int substeps) {
    Cloth cloth = cloth_of(scene, {.substeps = substeps, .threads = 1});
    const ModelInfo info = describe(*cloth.model());
    const auto items = static_cast<double>(info.constraints + info.membrane_elements);
    REQUIRE(info.membrane_elements > info.constraints);
    double sum = 0;
    for (int frame = 0; frame < 30; ++frame) {
      const StepReport report = step(cloth, kFrame);
      const auto sweeps = static_cast<double>(report.direction_updates);
      sum += sweeps + kLocalVisit * (static_cast<double>(report.visits) / items - sweeps);
    }
    return sum;
  };
  const double automatic = work(kAutomaticSubsteps);
  for (const int substeps : {1, 2, 4, 8}) {
    CAPTURE(substeps);
    CHECK(work(substeps) <= kMost * automatic);
  }
}

TEST_CASE("no iterations at all are for small steps in a given number") {
  const SceneDescription scene = scene_of("hang", 12);
  const auto refusal_of = [&](const Settings& settings) {
    const auto cloth = Cloth::create(model_of(scene), settings);
    return cloth ? std::string() : cloth.error();
  };
  const auto is_named = [](const std::string& message) {
    return message.find("max_iterations") != std::string::npos;
  };
  CHECK(refusal_of({.substeps = 4, .max_iterations = 0}).empty());
  CHECK(is_named(refusal_of({.max_iterations = 0})));
  CHECK(is_named(refusal_of({.substeps = 4, .max_iterations = 0, .solver = Solver::yarn})));
  CHECK(is_named(refusal_of({.substeps = 4, .max_iterations = -1})));
}

}  // namespace
}  // namespace weft::test::engine_step_budget
