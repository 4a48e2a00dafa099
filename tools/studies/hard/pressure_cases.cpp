/// Air that presses: far too much of it, and a pressure that turns over in every frame.
#include <weft/mesh.h>

#include <utility>

#include "tools/scenes/body_meshes.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

bool takes_pressure(const Method& method) {
  return method.solver == Solver::small_steps || label(method) == "auto";
}

/// A ball of cotton that decays.
SceneDescription balloon(int around) {
  constexpr double kRadius = 0.5;  // m
  const TriangleMesh ball = scenes::ball_mesh({{}, kRadius}, around);
  MeshDescription mesh;
  mesh.positions = ball.vertices;
  for (const auto& t : ball.triangles) mesh.corners.insert(mesh.corners.end(), t.begin(), t.end());
  mesh.material = find_material("cotton").value();
  mesh.material->drag = mesh.material->lift = 0;
  mesh.material->damping_motion = 2;
  return std::move(cloth_from_mesh(mesh).value().scene);
}

Trial inflated(const Setup& setup, SceneDescription scene) {
  Trial trial{std::move(scene), setup.settings(kLaw)};
  trial.steps = setup.steps(120, 20);
  trial.dt = 1. / 60;
  return trial;
}

/// By a third. (Threads of k N/m hold no more than k / 2 R: then a balloon grows without an end.)
Outcome run_over_inflated(const Setup& setup) {
  SceneDescription scene = balloon(20);
  scene.pressures = {{.pressure = 2500}};
  const Observed observed = observe(inflated(setup, std::move(scene)));
  Outcome result = honesty_outcome(observed, kAnyEnergy);
  result.figure = observed.missed;
  return result;
}

/// It is sucked flat and blown up again, and its layers keep off each other.
Outcome run_turning(const Setup& setup) {
  SceneDescription scene = balloon(14);
  scene.self_contact.on = true;
  Trial trial = inflated(setup, std::move(scene));
  trial.steps = setup.steps(30, 10);
  trial.before_step = [](Cloth& cloth, int step) {
    static_cast<void>(cloth.set_pressure(step % 2 == 0 ? 2000 : -2000));
  };
  const Observed observed = observe(trial);
  Outcome result = honesty_outcome(observed, kAnyEnergy);
  result.figure = static_cast<double>(observed.crossings);
  return result;
}

}  // namespace

std::vector<Case> pressure_cases() {
  return {{"balloon_over_inflated", "steps missed", 0, run_over_inflated, takes_pressure},
          {"pressure_turns_each_frame", "pairs of triangles that cross", 0, run_turning,
           takes_pressure}};
}

}  // namespace weft::tools::hard
