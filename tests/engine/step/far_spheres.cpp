/// What touches nothing changes nothing.
#include <doctest/doctest.h>
#include <weft/mesh.h>
#include <weft/weft.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_far_spheres {
namespace {

constexpr double kDt = 1. / 60;

/// A sheet that hangs on its first row, of so many particles that it has two tiles.
SceneDescription woven(bool is_cotton) {
  MeshDescription mesh = sheet(
      33, 32,
      [](double i, double j) {
        return Vec3{0.02 * j, -0.02 * i * std::sqrt(0.5), 0.02 * i * std::sqrt(0.5)};
      },
      [](auto, auto) { return Cut::none; });
  for (std::uint32_t j = 0; j < 32; ++j) mesh.pins.push_back(j);
  if (is_cotton) mesh.material = find_material("cotton").value();
  return made(mesh).scene;
}

void add_sphere(SceneDescription& scene, Vec3 at, double radius, bool is_fixed) {
  const auto i = static_cast<std::uint32_t>(scene.positions.size());
  scene.spheres.push_back(i);
  if (is_fixed) scene.fixed.push_back(i);
  scene.positions.push_back(at);
  if (!scene.velocities.empty()) scene.velocities.push_back({0, 0, 0});
  scene.masses.push_back(5);
  scene.radii.resize(scene.positions.size());
  scene.radii.back() = radius;
}

/// The first `moved` of the fixed spheres run to and fro; the pins sway.
void run(Cloth& cloth, const SceneDescription& scene, std::uint32_t moved, int frame) {
  for (std::uint32_t pin = 0; pin < 32; ++pin) {
    const Vec3 from = scene.positions[pin];
    REQUIRE(cloth.move_fixed(pin, from + Vec3{0.05 * std::sin(0.2 * frame), 0, 0.01 * frame}));
  }
  for (std::uint32_t i = 0; i < moved; ++i) {
    const std::uint32_t sphere = scene.spheres[i];
    REQUIRE(
        cloth.move_fixed(sphere, scene.positions[sphere] + Vec3{3 * std::sin(0.3 * frame), 0, 0}));
  }
}

/// With nine spheres that nothing comes to: some far, some beside the sheet, one that falls.
SceneDescription with_spheres(SceneDescription scene) {
  for (int i = 0; i < 6; ++i) add_sphere(scene, {20. + i, -1, 50}, 0.2, true);
  add_sphere(scene, {-0.3, -0.2, 0.4}, 0.1, true);
  add_sphere(scene, {0.3, 0.5, 0.2}, 0.1, true);
  add_sphere(scene, {100, 0, 0}, 0.2, false);
  return scene;
}

void check_same(const SceneDescription& scene, const Settings& settings) {
  const SceneDescription other = with_spheres(scene);
  Cloth alone = cloth_of(scene, settings), among = cloth_of(other, settings);
  REQUIRE(among.settings().solver == alone.settings().solver);
  REQUIRE(among.settings().scheme == alone.settings().scheme);
  for (int frame = 1; frame <= 40; ++frame) {
    CAPTURE(frame);
    run(alone, scene, 0, frame);
    run(among, other, 3, frame);
    const StepReport a = step(alone, kDt), b = step(among, kDt);
    REQUIRE(b.status == a.status);
    REQUIRE(b.substeps == a.substeps);
    REQUIRE(b.visits == a.visits);
    REQUIRE(b.contacts == 0);
    std::vector<Vec3> x = positions(among), v = velocities(among);
    x.resize(scene.positions.size());
    v.resize(scene.positions.size());
    REQUIRE(largest_distance(positions(alone), x) == 0);
    REQUIRE(largest_distance(velocities(alone), v) == 0);
  }
}

TEST_CASE("spheres that touch nothing change no bit, and no visit, by small steps") {
  for (const Backend backend : kBackends) {
    for (const bool is_cotton : {true, false}) {
      CAPTURE(name(backend));
      CAPTURE(is_cotton);
      check_same(woven(is_cotton),
                 {.solver = Solver::small_steps, .backend = backend, .threads = 1});
    }
  }
}

TEST_CASE("spheres that touch nothing change no bit where substeps are given, or wind blows") {
  SceneDescription scene = woven(true);
  check_same(scene, {.substeps = 6, .max_iterations = 20});
  scene.air.wind = {4, 0, 1};
  check_same(scene, {});
}

}  // namespace
}  // namespace weft::test::engine_step_far_spheres
