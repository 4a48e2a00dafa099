/// Cloth of a material: springs from soft to rigid, boards, wind, and meshes that nobody made well.
#include <fmt/format.h>
#include <weft/mesh.h>

#include <cmath>
#include <utility>

#include "tools/scenes/scenes.h"
#include "tools/studies/hard/scenes.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

bool solves_springs(const Method& method) { return method.scheme != Scheme::rattle; }

bool bends(const Method& method) {
  const bool is_small_steps = method.solver == Solver::small_steps;
  return is_small_steps || (method.solver == Solver::automatic && solves_springs(method));
}

Outcome run_material(const Setup& setup, const SceneDescription& scene) {
  Trial trial{scene, setup.settings(kLaw)};
  trial.steps = setup.steps(300, 40);
  trial.dt = 1. / 60;
  return gain_outcome(trial);
}

/// A wind that turns about ten times a second.
Outcome run_gusts(const Setup& setup) {
  Trial trial{scenes::make("flag", {.size = 20}).value(), setup.settings(kLaw)};
  trial.steps = setup.steps(300, 40);
  trial.dt = 1. / 60;
  trial.before_step = [](Cloth& cloth, int step) {
    const double side = step / 6 % 2 == 0 ? 1 : -1;
    static_cast<void>(cloth.set_wind({10, 0, 20 * side}));
  };
  const Observed observed = observe(trial);
  Outcome result = strain_outcome(observed, kAnyEnergy);
  result.figure = observed.missed;
  return result;
}

/// Edges that are rigid, and springs from 10^-9 to 1 m/N, side by side.
SceneDescription stiffness_over_decades() {
  SceneDescription scene = sheet("hang", 20);
  for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
    const auto decade = static_cast<double>(i % 11);
    if (decade > 0) scene.constraints[i].compliance = std::pow(10., decade - 10);
  }
  return scene;
}

Material undamped(double bending) {
  Material material = find_material("cotton").value();
  material.bending = bending;
  material.damping_stretch = material.damping_bending = 0;
  material.drag = material.lift = 0;
  return material;
}

SceneDescription cloth_of(MeshDescription mesh, double bending) {
  mesh.material = undamped(bending);
  return std::move(cloth_from_mesh(mesh).value().scene);
}

/// A level grid of 20 x 20, the column i = 0 fixed.
MeshDescription grid() {
  constexpr std::uint32_t kSize = 20;
  MeshDescription mesh;
  for (std::uint32_t i = 0; i < kSize; ++i) {
    for (std::uint32_t j = 0; j < kSize; ++j) mesh.positions.push_back({0.05 * i, 0, 0.05 * j});
  }
  for (std::uint32_t i = 0; i + 1 < kSize; ++i) {
    for (std::uint32_t j = 0; j + 1 < kSize; ++j) {
      const std::uint32_t a = i * kSize + j;
      mesh.corners.insert(mesh.corners.end(), {a, a + 1, a + kSize + 1, a + kSize});
      mesh.face_sizes.push_back(4);
    }
  }
  for (std::uint32_t j = 0; j < kSize; ++j) mesh.pins.push_back(j);
  return mesh;
}

/// Triangles a thousand times as long as they are wide, along x.
MeshDescription slivers() {
  MeshDescription mesh;
  for (std::uint32_t k = 0; k < 40; ++k) {
    mesh.positions.push_back({0, 0, 0.001 * k});
    mesh.positions.push_back({1, 0, 0.001 * (k + 0.5)});
    if (k > 0) mesh.corners.insert(mesh.corners.end(), {2 * k - 2, 2 * k - 1, 2 * k});
    if (k > 0) mesh.corners.insert(mesh.corners.end(), {2 * k - 1, 2 * k + 1, 2 * k});
    mesh.pins.push_back(2 * k);
  }
  return mesh;
}

/// Three sheets on one edge, and a corner of triangles in the middle of another's edge.
MeshDescription not_a_surface() {
  MeshDescription mesh;
  mesh.positions = {{0, 0, 0},      {0, 0, 1},   {1, 0, 0},    {1, 0, 1},   {1, 0.5, 0.5},
                    {1, -0.5, 0.5}, {2, 0, 0.5}, {2, 0, 0.25}, {1, 0, 0.5}, {3, 0, 0.5}};
  mesh.corners = {0, 1, 2, 1, 3, 2, 2, 3, 4, 2, 3, 5, 2, 3, 6, 8, 6, 7, 6, 7, 9};
  mesh.pins = {0, 1};
  return mesh;
}

/// 300 pieces of two triangles, each with a corner fixed.
MeshDescription pieces_of_cloth() {
  MeshDescription mesh;
  for (std::uint32_t k = 0; k < 300; ++k) {
    const double x = 2.0 * (k % 20), z = 2.0 * (k / 20);
    for (const auto& [dx, dz] : {std::pair{0., 0.}, {1., 0.}, {1., 1.}, {0., 1.}}) {
      mesh.positions.push_back({x + dx, 0, z + dz});
    }
    const std::uint32_t a = 4 * k;
    mesh.corners.insert(mesh.corners.end(), {a, a + 1, a + 2, a, a + 2, a + 3});
    mesh.pins.push_back(a);
  }
  return mesh;
}

}  // namespace

std::vector<Case> material_cases() {
  constexpr double kCotton = 1e-5, kBoard = 1;  // N m
  const std::pair<const char*, SceneDescription> scenes[] = {
      {"stiffness_over_nine_decades", stiffness_over_decades()},
      {"bends_not_at_all", cloth_of(grid(), 0)},
      {"bends_like_a_board", cloth_of(grid(), kBoard)},
      {"slivers", cloth_of(slivers(), kCotton)},
      {"not_a_surface", cloth_of(not_a_surface(), kCotton)},
      {"cloth_in_300_pieces", cloth_of(pieces_of_cloth(), kCotton)},
  };
  std::vector<Case> cases;
  for (const auto& [name, scene] : scenes) {
    cases.push_back({name, "J gained", kMostGained,
                     [scene = scene](const Setup& setup) { return run_material(setup, scene); },
                     scene.bending.empty() ? solves_springs : bends});
  }
  cases.push_back({"gusts", "frames that miss their laws", 0, run_gusts, bends});
  return cases;
}

}  // namespace weft::tools::hard
