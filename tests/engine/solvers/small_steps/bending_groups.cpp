/// How many substeps have one solution of bending, and that cloth moves as if each had its own.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/bending_frame.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/solvers/small_steps/substep_formula.h"
#include "engine/tuning.h"
#include "tests/support/bending.h"
#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_small_steps_bending_groups {
namespace {

constexpr double kFrame = 0.01;

Settings settings_on(Backend backend, int substeps) {
  Settings settings;
  settings.solver = Solver::small_steps;
  settings.backend = backend;
  settings.substeps = substeps;
  settings.threads = 1;
  return settings;
}

/// How often bending is solved in a frame. Its impulses are those of all substeps, in the middle of
/// their groups: each is half of the way from the one before to the one after, of frames that are
/// all alike.
int solutions(BendingFrame& bending, const FramePlan& plan) {
  bending.begin(plan, 1);
  const double give = SubstepFormula::of(Scheme::bdf2, 1).give(plan.dt_substep);
  std::vector<int> at;
  std::vector<double> impulse;
  for (int k = 0; k < plan.substeps; ++k) {
    const auto step = bending.next(give);
    if (!step) continue;
    CHECK(step->count <= tuning::kLongestGroup);
    at.push_back(k);
    impulse.push_back(step->count);
  }
  double impulses = 0, moments = 0;
  const std::size_t count = at.size();
  for (std::size_t i = 0; i < count; ++i) {
    const int before = i > 0 ? at[i - 1] : at.back() - plan.substeps;
    const int after = i + 1 < count ? at[i + 1] : at.front() + plan.substeps;
    CHECK(impulse[i] == 0.5 * (after - before));
    impulses += impulse[i];
    moments += impulse[i] * (at[i] + 1);
  }
  CHECK(impulses == plan.substeps);
  CHECK(std::abs(moments / impulses - 0.5 * plan.substeps) <= 0.5 + 1e-9);
  return static_cast<int>(count);
}

TEST_CASE("solutions stand for all substeps of a frame, and soft cloth has few") {
  const auto model = model_of(cantilever({}));
  BendingFrame bending(*model, settings_on(Backend::simd, 1));
  for (const int substeps : {1, 2, 3, 7, 8, 9, 31, 64}) {
    CHECK(solutions(bending, {.dt_substep = 0.01, .substeps = substeps}) == substeps);
    CHECK(solutions(bending, {.dt_substep = 1e-6, .substeps = substeps}) ==
          (substeps + tuning::kLongestGroup - 1) / tuning::kLongestGroup);
  }
}

TEST_CASE("the stiffest particle bounds how many substeps have one solution") {
  SceneDescription scene = cantilever({});
  scene.bending.back().compliance /= 100;
  const auto stiff = model_of(scene);
  const auto usual = model_of(cantilever({}));
  BendingFrame bending(*stiff, settings_on(Backend::simd, 1));
  BendingFrame softer(*usual, settings_on(Backend::simd, 1));
  // Of a strip of 8 segments of 25 mm. The row 1 4 6 4 1 has the end's half a mass in it.
  const double row = 16.42 * 1e-3 / (0.2 * std::pow(0.025, 4));
  const double h = std::sqrt(tuning::kBendingGroup / row) / 4.01;
  CHECK(solutions(softer, {.dt_substep = h, .substeps = 64}) == 16);
  CHECK(solutions(bending, {.dt_substep = h, .substeps = 64}) == 64);
}

TEST_CASE("what is solved in few substeps moves nearly as what is solved in each") {
  // The same strip in substeps as short as the groups of the first, and as its substeps.
  const SceneDescription strip = cantilever({.stiffness = 1e-4});
  const auto tip = static_cast<std::uint32_t>(strip.positions.size() - 1);
  for (const Backend backend : kBackends) {
    Cloth few = cloth_of(strip, settings_on(backend, 80));
    Cloth many = cloth_of(strip, settings_on(backend, 640));
    run(few, kFrame, 30);
    run(many, kFrame, 30);
    const double apart = distance(few.position(tip), many.position(tip));
    CHECK(apart > 0);
    CHECK(apart < 5e-3 * distance(few.position(tip), strip.positions[tip]));
  }
}

TEST_CASE("a stiff strip beside much that is soft moves as alone") {
  const SceneDescription alone = cantilever({.stiffness = 1e-4});
  SceneDescription mixed = alone;
  const auto tip = static_cast<std::uint32_t>(alone.positions.size() - 1);
  for (std::uint32_t k = 0; k < 3 * alone.bending.size(); ++k) {
    const auto first = static_cast<std::uint32_t>(mixed.positions.size());
    for (std::uint32_t i = 0; i < 3; ++i) {
      mixed.positions.push_back({0.02 * i, 1.0 + k, 0});
      mixed.masses.push_back(alone.masses[2]);
    }
    mixed.bending.push_back({{first, first + 1, first + 2, kNoIndex}, {1, -2, 1, 0}, 0, 1e5});
  }
  for (const Backend backend : kBackends) {
    Cloth one = cloth_of(alone, settings_on(backend, 80));
    Cloth other = cloth_of(mixed, settings_on(backend, 80));
    run(one, kFrame, 30);
    run(other, kFrame, 30);
    CHECK(distance(one.position(tip), other.position(tip)) <
          0.01 * distance(one.position(tip), alone.positions[tip]));
  }
}

// ------------------------------------------------------------------------------ uneven groups

constexpr std::uint32_t kAcross = 6, kAlong = 60;

/// A plate of 30 mm, from 6 to 10 m around the middle, that is slit. It is clamped on one side of
/// the slit, and has no weight.
SceneDescription slit_annulus() {
  MeshDescription mesh;
  const auto at = [](std::uint32_t i, std::uint32_t j) { return i * (kAcross + 1) + j; };
  for (std::uint32_t i = 0; i <= kAlong; ++i) {
    const double angle = 2 * std::numbers::pi * i / kAlong;
    for (std::uint32_t j = 0; j <= kAcross; ++j) {
      const double r = 6 + 4.0 * j / kAcross;
      mesh.positions.push_back({r * std::cos(angle), 0, r * std::sin(angle)});
      if (i <= 1) mesh.pins.push_back(at(i, j));
      if (i == kAlong || j == kAcross) continue;
      mesh.corners.insert(mesh.corners.end(),
                          {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      mesh.face_sizes.push_back(4);
    }
  }
  mesh.material = Material{.density = 0.01,
                           .warp = 630e3,
                           .weft = 630e3,
                           .shear = 315e3,
                           .bending = 47.25,
                           .damping_motion = 1.2};
  SceneDescription scene = cloth_from_mesh(mesh).value().scene;
  scene.gravity = {};
  return scene;
}

// Impulses that were as many substeps as their groups gave an uneven one a kick in each frame: the
// plate had 25 J, of which the load explained 11.
TEST_CASE("groups of unequal lengths gain no energy") {
  const SceneDescription scene = slit_annulus();
  std::vector<Vec3> forces(scene.positions.size());
  for (std::uint32_t j = 0; j <= kAcross; ++j)
    forces[kAlong * (kAcross + 1) + j].y = 3.2 / kAcross * (j == 0 || j == kAcross ? 0.5 : 1);
  Settings settings = settings_on(Backend::simd, 180);
  settings.tolerance = 1e-3;
  Cloth cloth = cloth_of(scene, settings);
  REQUIRE(cloth.write_forces(forces));
  for (int frame = 0; frame < 420; ++frame) {
    const StepReport report = step(cloth, 1. / 60);
    REQUIRE(report.status == Status::converged);
  }
  CHECK(cloth.energy().elastic < 14);
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_bending_groups
