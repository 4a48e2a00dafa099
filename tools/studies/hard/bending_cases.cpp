/// Cloth that bends hardly at all: plates, card, folds, and fine cells.
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "tools/studies/hard/body_trial.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

constexpr double kSoft = 1e-6, kCard = 1, kPlate = 10, kSteel = 1e3;  // N m

Material plain_material(double bending) {
  return {.density = 0.5, .warp = 2e4, .weft = 2e4, .shear = 1e4, .bending = bending};
}

struct Grid {
  std::uint32_t along = 20, across = 20;  // particles
  double cell = 0.02;                     // m
  bool is_fixed = true;                   // its first column
};

/// Level, or folded up by a right angle in the middle.
MeshDescription plate_mesh(const Grid& grid, double bending, bool is_folded = false) {
  MeshDescription mesh;
  const double fold = is_folded ? grid.cell * (grid.along / 2) : 1e9;
  for (std::uint32_t i = 0; i < grid.along; ++i) {
    const double x = grid.cell * i;
    for (std::uint32_t j = 0; j < grid.across; ++j)
      mesh.positions.push_back({std::min(x, fold), std::max(0., x - fold), grid.cell * j});
  }
  for (std::uint32_t i = 0; i + 1 < grid.along; ++i) {
    for (std::uint32_t j = 0; j + 1 < grid.across; ++j) {
      const std::uint32_t a = i * grid.across + j;
      mesh.corners.insert(mesh.corners.end(), {a, a + 1, a + grid.across + 1, a + grid.across});
      mesh.face_sizes.push_back(4);
    }
  }
  for (std::uint32_t j = 0; grid.is_fixed && j < grid.across; ++j) mesh.pins.push_back(j);
  mesh.material = plain_material(bending);
  return mesh;
}

SceneDescription bending_cloth(const MeshDescription& mesh) {
  return std::move(cloth_from_mesh(mesh).value().scene);
}

/// Soft on the side of the pins, and beyond the middle a plate.
SceneDescription stiff_beside_soft() {
  const Grid grid;
  SceneDescription scene = bending_cloth(plate_mesh(grid, kSoft));
  const double middle = grid.cell * grid.along / 2;
  for (BendingElement& e : scene.bending) {
    if (scene.positions[e.particles[0]].x > middle) e.compliance *= kSoft / kPlate;
  }
  return scene;
}

/// A strip two cells wide that turns about its middle, end over end.
SceneDescription spinning_rod() {
  const Grid grid{.along = 31, .across = 3, .cell = 0.02, .is_fixed = false};
  SceneDescription scene = bending_cloth(plate_mesh(grid, kPlate));
  scene.gravity = {};
  const double middle = grid.cell * (grid.along - 1) / 2;
  for (const Vec3 p : scene.positions) scene.velocities.push_back({0, 10 * (p.x - middle), 0});
  return scene;
}

Outcome run_bends(const Setup& setup, const SceneDescription& scene) {
  Trial trial{scene, setup.settings(kLaw)};
  trial.steps = setup.steps(300, 40);
  trial.dt = 1. / 60;
  return gain_outcome(trial);
}

Outcome run_uneven_frames(const Setup& setup) {
  Trial trial{bending_cloth(plate_mesh({}, kCard)), setup.settings(kLaw)};
  trial.steps = setup.steps(300, 40);
  trial.varying_dt = [](int step) { return step % 7 < 3 ? 0.004 : step % 7 < 5 ? 0.016 : 0.033; };
  return gain_outcome(trial);
}

/// It comes edge on, by 5 m/s.
Outcome run_card_hits_wall(const Setup& setup) {
  const Grid grid{.is_fixed = false};
  SceneDescription scene = bending_cloth(plate_mesh(grid, kCard));
  scene.gravity = {};
  scene.velocities.assign(scene.positions.size(), {0, -5, 0});
  const double slope = 1.25;  // rad
  for (Vec3& p : scene.positions) p = {std::cos(slope) * p.x, 0.05 + std::sin(slope) * p.x, p.z};
  Trial trial = trial_of(setup, std::move(scene), {{Plane{}, 0.3, stays()}});
  trial.steps = setup.steps(60, 20);
  return depth_outcome(observe(trial));
}

}  // namespace

std::vector<Case> bending_cases() {
  const std::pair<const char*, SceneDescription> scenes[] = {
      {"bends_like_steel", bending_cloth(plate_mesh({}, kSteel))},
      {"stiff_beside_soft", stiff_beside_soft()},
      {"folded_at_a_right_angle", bending_cloth(plate_mesh({}, 1e-3, true))},
      {"cells_of_a_third_of_a_millimetre", bending_cloth(plate_mesh({.cell = 3e-4}, 64e-6))},
      {"a_rod_spins", spinning_rod()},
      {"bends_by_nothing", bending_cloth(plate_mesh({}, 0))},
  };
  std::vector<Case> cases;
  for (const auto& [name, scene] : scenes) {
    cases.push_back({name, "J gained", kMostGained,
                     [scene = scene](const Setup& setup) { return run_bends(setup, scene); },
                     takes_bodies});
  }
  cases.push_back(
      {"card_in_frames_of_4_to_33_ms", "J gained", kMostGained, run_uneven_frames, takes_bodies});
  cases.push_back({"card_hits_a_wall", "m deep in a body", kContactTolerance, run_card_hits_wall,
                   takes_bodies});
  return cases;
}

}  // namespace weft::tools::hard
