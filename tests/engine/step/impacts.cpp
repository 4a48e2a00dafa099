/// Loads that arrive within a frame: it is done again with as many substeps as they need.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/free_body.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_impacts {
namespace {

constexpr int kRates[] = {30, 60, 240};
constexpr double kG = 10;        // m/s^2
constexpr double kHeight = 0.6;  // m

/// A square of 1 m whose rim is pinned, N/m in both directions.
SceneDescription canvas(std::uint32_t size, bool is_of_quads, double stiffness) {
  MeshDescription mesh = is_of_quads ? quads(size) : equilateral_triangles(size);
  const double spacing = 1. / (size - 1);
  for (Vec3& v : mesh.positions) v = {spacing * v.x - 0.5, 0, spacing * v.y - 0.5};
  Material material = find_material("cotton").value();
  material.warp = material.weft = stiffness;
  material.shear = stiffness / 3;
  mesh.material = material;
  for (std::uint32_t i = 0; i < size * size; ++i) {
    const std::uint32_t row = i / size, column = i % size;
    if (row == 0 || row + 1 == size || column == 0 || column + 1 == size) mesh.pins.push_back(i);
  }
  SceneDescription scene = made(mesh).scene;
  scene.gravity = {0, -kG, 0};
  return scene;
}

struct Fall {
  double lowest = 0, highest = 0;  // m, of the centre; after the lowest place
  int missed = 0, repeated = 0;    // frames
  double gained = 0;               // J, of all, at most
};
/// Of a ball of 60 mm, from kHeight, for a second.
Fall fall(const SceneDescription& scene, double mass, int rate, double tolerance) {
  Cloth cloth =
      cloth_of(scene, {.tolerance = tolerance, .solver = Solver::small_steps, .threads = 1});
  const Free ball = add_free(cloth, Ball{{}, 0.06}, mass, {.position = {0.03, kHeight, 0.02}});
  const auto energy = [&] { return ball.energy(cloth, kG) + cloth.energy().total(); };
  const double before = energy();
  Fall found{.lowest = 1, .gained = 0};
  for (int frame = 0; frame < rate; ++frame) {
    const StepReport report = step(cloth, 1. / rate);
    found.missed += report.status == Status::converged ? 0 : 1;
    found.repeated += report.halvings > 0 ? 1 : 0;
    found.gained = std::max(found.gained, energy() - before);
    const double height = ball.centre(cloth).y;
    if (height < found.lowest) found.lowest = found.highest = height;
    found.highest = std::max(found.highest, height);
  }
  return found;
}

/// The tolerance bounds strains, and the energy that they have: 9 J at 1 % of 2 10^5 N/m.
TEST_CASE("a ball as heavy as canvas, and heavier, falls on it and does not go through") {
  for (const bool is_of_quads : {true, false}) {
    for (const double stiffness : {5e3, 2e4, 2e5}) {
      const SceneDescription scene = canvas(21, is_of_quads, stiffness);
      for (const int rate : kRates) {
        for (const double mass : {0.2, 1.0, 2.0}) {
          CAPTURE(is_of_quads);
          CAPTURE(stiffness);
          CAPTURE(rate);
          CAPTURE(mass);
          const Fall found = fall(scene, mass, rate, 1e-2);
          CHECK(found.lowest > (stiffness < 1e5 ? -0.2 : -0.1));
          CHECK(found.highest > found.lowest + 0.15);
          CHECK(found.highest < 1.05 * kHeight);
          CHECK(found.missed <= 1);
        }
      }
    }
  }
}

TEST_CASE("at a small tolerance it bounces, and no energy is gained") {
  for (const double stiffness : {2e4, 2e5}) {
    const SceneDescription scene = canvas(21, true, stiffness);
    for (const int rate : kRates) {
      CAPTURE(stiffness);
      CAPTURE(rate);
      const Fall found = fall(scene, 1, rate, 1e-3);
      CHECK(found.lowest > -0.1);
      CHECK(found.highest > found.lowest + 0.15);
      CHECK(found.gained < 1e-3);
      CHECK(found.missed <= 1);
      CHECK(found.highest < 1.05 * kHeight);
      CHECK(found.repeated > 0);
      CHECK(found.repeated <= rate / 20 + 2);
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_step_impacts
