/// Fabric that is put somewhere, by its pins, by its positions or where it starts, becomes no
/// faster than rigid edges do; what it carries, and springs whose swings are seen, stay.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <weft/mesh.h>

#include "tests/support/clothes.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_placed_fabric {
namespace {

constexpr double kFrame = 1. / 60;

/// 1 m x 1 m that hangs by its first row.
SceneDescription curtain(const char* material, std::uint32_t size, Cut cut) {
  const double spacing = 1. / (size - 1);
  MeshDescription mesh = sheet(
      size, size,
      [&](double row, double column) {
        return spacing * Vec3{column, -row, 0};
      },
      [&](std::uint32_t, std::uint32_t) { return cut; });
  mesh.material = find_material(material).value();
  for (std::uint32_t i = 0; i < size; ++i) mesh.pins.push_back(i);
  return made(mesh).scene;
}

double top_speed(const Cloth& cloth) {
  double most = 0;
  for (const Vec3& v : velocities(cloth)) most = std::max(most, length(v));
  return most;
}

void place_pins(Cloth& cloth, const SceneDescription& scene, Vec3 by) {
  for (const std::uint32_t pin : scene.fixed)
    REQUIRE(cloth.place_fixed(pin, scene.positions[pin] + by));
}

struct Case {
  const char* material;
  Cut cut;
  Settings settings;
};
std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const char* material : {"cotton", "silk"}) {
    for (const Cut cut : {Cut::none, Cut::first}) {
      for (const double tolerance : {0.01, 0.001})
        cases.push_back({material, cut, {.tolerance = tolerance, .threads = 1}});
    }
  }
  cases.push_back({"cotton",
                   Cut::none,
                   {.solver = Solver::small_steps, .backend = Backend::reference, .threads = 1}});
  cases.push_back({"cotton", Cut::none, {.solver = Solver::yarn, .threads = 1}});
  cases.push_back({"cotton", Cut::none, {.solver = Solver::direct, .threads = 1}});
  for (Case& c : cases) {
    const bool exact = c.settings.solver == Solver::yarn || c.settings.solver == Solver::direct;
    if (exact) c.settings.scheme = Scheme::paper;
  }
  return cases;
}

/// What exact solvers take: springs alone.
SceneDescription without_bending(SceneDescription scene) {
  scene.bending.clear();
  return scene;
}

TEST_CASE("fabric whose pins are put down elsewhere follows without becoming fast") {
  for (const Case& c : all_cases()) {
    for (const double jump : {0.02, 0.1, 0.3}) {
      for (const Vec3 by : {Vec3{0, jump, 0}, Vec3{jump, 0, 0.5 * jump}}) {
        CAPTURE(std::string(c.material));
        CAPTURE(static_cast<int>(c.cut));
        CAPTURE(c.settings.tolerance);
        CAPTURE(std::string(name(c.settings.solver)));
        CAPTURE(jump);
        CAPTURE(by.x);
        SceneDescription scene = without_bending(curtain(c.material, 13, c.cut));
        if (by.y == 0) scene.gravity = {0, 0, 0};  // or it would swing
        Cloth cloth = cloth_of(scene, c.settings);
        run(cloth, kFrame, 3);
        place_pins(cloth, scene, by);
        CHECK(step(cloth, kFrame).status == Status::converged);
        CHECK(top_speed(cloth) <= (by.y > 0 ? 0.1 : 0.4));  // askew it gives way slowly
        CHECK(step(cloth, kFrame).max_error <= c.settings.tolerance);
      }
    }
  }
}

TEST_CASE("what fabric carries it carries on where its pins are put") {
  SceneDescription scene = curtain("cotton", 13, Cut::none);
  scene.damping.motion = 5;
  Cloth cloth = cloth_of(scene, {.threads = 1});
  run(cloth, kFrame, 300);
  const Energy before = cloth.energy();
  REQUIRE(before.elastic > 1e-6);
  place_pins(cloth, scene, {0, 0.05, 0});
  step(cloth, kFrame);
  CHECK(cloth.energy().elastic == doctest::Approx(before.elastic).epsilon(0.1));
  CHECK(top_speed(cloth) < 0.02);
}

TEST_CASE("fabric that starts or is written too long or too short becomes no faster either") {
  for (const Case& c : all_cases()) {
    for (const double scale : {0.8, 1.1, 1.5}) {
      CAPTURE(std::string(c.material));
      CAPTURE(static_cast<int>(c.cut));
      CAPTURE(c.settings.tolerance);
      CAPTURE(std::string(name(c.settings.solver)));
      CAPTURE(scale);
      SceneDescription scene = without_bending(curtain(c.material, 13, c.cut));
      scene.gravity = {0, 0, 0};
      SceneDescription other = scene;
      for (Vec3& x : other.positions) x.y *= scale;
      Cloth started = cloth_of(other, c.settings), written = cloth_of(scene, c.settings);
      step(written, kFrame);
      REQUIRE(written.write_positions(positions(started)));
      step(started, kFrame);
      step(written, kFrame);
      CHECK(top_speed(started) <= 0.1);
      CHECK(top_speed(written) <= 0.1);
      CHECK(step(started, kFrame).max_error <= c.settings.tolerance);
    }
  }
}

TEST_CASE("cloth that is written back as it was goes on as it would have") {
  SceneDescription scene = curtain("cotton", 13, Cut::first);
  scene.fixed.resize(1);
  Cloth cloth = cloth_of(scene, {.threads = 1});
  for (int k = 0; k < 60; ++k) {
    step(cloth, kFrame);
    if (k % 10 != 9) continue;
    Cloth written = cloth.clone();
    REQUIRE(written.write_positions(positions(cloth)));
    REQUIRE(written.write_velocities(velocities(cloth)));
    step(written, kFrame);
    Cloth clone = cloth.clone();
    step(clone, kFrame);
    CAPTURE(k);
    CHECK(largest_distance(positions(written), positions(clone)) < 0.005);
  }
}

TEST_CASE("a spring whose swings are seen keeps its stretch where its pin is put down") {
  for (const Solver solver : {Solver::small_steps, Solver::yarn}) {
    SceneDescription scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}};
    scene.masses = {1, 1};
    scene.fixed = {0};
    scene.gravity = {0, 0, 0};
    scene.constraints = {{0, 1, 1, ConstraintKind::distance, 1. / 40}};
    Settings settings{.tolerance = 1e-4, .solver = solver, .threads = 1};
    if (solver == Solver::yarn) settings.scheme = Scheme::paper;
    Cloth cloth = cloth_of(scene, settings);
    step(cloth, kFrame);
    REQUIRE(cloth.place_fixed(0, {-0.2, 0, 0}));
    step(cloth, 1e-4);
    CHECK(distance(cloth.position(1), {1, 0, 0}) < 1e-5);
    CHECK(cloth.velocity(1).x == doctest::Approx(-40 * 0.2 * 1e-4).epsilon(0.01));
  }
}

TEST_CASE("fabric of which the rest changes becomes no faster") {
  SceneDescription scene = without_bending(curtain("cotton", 13, Cut::none));
  scene.gravity = {0, 0, 0};
  scene.fixed.clear();
  Cloth cloth = cloth_of(scene, {.threads = 1});
  step(cloth, kFrame);
  Changes changes;
  for (std::uint32_t c = 0; c < scene.constraints.size(); ++c)
    changes.rest_lengths.push_back({c, 0.8 * scene.constraints[c].rest_length});
  REQUIRE(cloth.change(changes));
  step(cloth, kFrame);
  CHECK(top_speed(cloth) <= 0.1);
}

}  // namespace
}  // namespace weft::test::engine_step_placed_fabric
