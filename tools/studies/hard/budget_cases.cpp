/// A number of substeps that was given: it bounds a frame whatever happens in it, and no energy
/// comes of frames that differ in length.
#include <fmt/format.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string_view>

#include "tools/studies/hard/scenes.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

bool by_small_steps(const Method& method) { return method.solver == Solver::small_steps; }

/// What is done to a scene to make its frames hard.
enum class Trouble { none, pins_part, out_of_shape };

/// The work of a frame, in visits that take as long as one of a sweep, over that of its substeps'
/// sweeps. Visits of contacts are left out: those that are found are visited in each substep.
double work_of(const StepReport& report, const ModelInfo& model, int substeps) {
  constexpr double kLocalVisit = 8;
  const auto items = static_cast<double>(model.constraints + model.membrane_elements);
  const auto sweeps = static_cast<double>(report.direction_updates);
  const double contacts = static_cast<double>(report.contacts) * (substeps + 1);
  const double local = static_cast<double>(report.visits) - sweeps * items - contacts;
  return (sweeps + kLocalVisit * std::max(0.0, local) / items) / substeps;
}

void disturb(Cloth& cloth, Trouble trouble, const std::vector<std::uint32_t>& fixed, int frame) {
  if (trouble == Trouble::pins_part && frame < 20)
    (void)cloth.move_fixed(fixed.back(), cloth.position(fixed.back()) + Vec3{0.02, 0, 0.02});
  if (trouble == Trouble::out_of_shape && frame % 10 == 5) {
    std::vector<Vec3> positions = snapshot(cloth).positions;
    for (Vec3& position : positions) position = 1.3 * position;
    (void)cloth.write_positions(positions);
  }
}

Outcome run_budget(const Setup& setup, const SceneDescription& scene, Trouble trouble) {
  constexpr int kSubsteps = 8;
  Settings settings = setup.settings(0.01);
  settings.substeps = kSubsteps;
  settings.max_iterations = kSubsteps / 4;
  const auto model = build_model(scene);
  auto cloth = Cloth::create(model.value(), settings);
  Outcome outcome{0, {}, {}, 0};
  int missed = 0;
  const int steps = setup.steps(100, 20);
  for (int frame = 0; frame < steps; ++frame) {
    disturb(cloth.value(), trouble, scene.fixed, frame);
    const auto report = cloth.value().step(1. / 60).value();
    missed += report.status != Status::converged;
    outcome.figure = std::max(outcome.figure, work_of(report, describe(*model.value()), kSubsteps));
    if (!committed(report.status)) outcome.failure = fmt::format("frame {} was not done", frame);
  }
  outcome.detail = fmt::format("{} frames, {} of which missed the tolerance", steps, missed);
  return outcome;
}

/// A strip of 7 x 13 that swings from 45 degrees.
MeshDescription strip(bool is_cotton) {
  constexpr std::uint32_t kWidth = 7, kLength = 13;
  constexpr double kCell = 0.04;
  MeshDescription mesh;
  for (std::uint32_t i = 0; i < kLength; ++i) {
    for (std::uint32_t j = 0; j < kWidth; ++j) {
      const double down = kCell * i / std::numbers::sqrt2;
      mesh.positions.push_back({kCell * j, -down, down});
    }
  }
  for (std::uint32_t i = 0; i + 1 < kLength; ++i) {
    for (std::uint32_t j = 0; j + 1 < kWidth; ++j) {
      const std::uint32_t a = i * kWidth + j;
      mesh.corners.insert(mesh.corners.end(), {a, a + 1, a + 1 + kWidth, a + kWidth});
      mesh.face_sizes.push_back(4);
    }
  }
  for (std::uint32_t j = 0; j < kWidth; ++j) mesh.pins.push_back(j);
  if (is_cotton) {
    mesh.material = find_material("cotton").value();
    mesh.material->drag = mesh.material->lift = 0;
  } else {
    mesh.mass = 0.0146;
  }
  return mesh;
}

/// J, that the strip gives off until it hangs.
double energy_of_the_swing(const SceneDescription& scene) {
  double energy = 0;
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    const double hangs = scene.positions[i].y * std::numbers::sqrt2;
    energy += scene.masses[i] * length(scene.gravity) * (scene.positions[i].y - hangs);
  }
  return energy;
}

/// Frames of 4 to 33 ms at random, or these two in turns.
Outcome run_frames(const Setup& setup, bool is_cotton, double tolerance, bool in_turns) {
  Trial trial{cloth_from_mesh(strip(is_cotton)).value().scene, setup.settings(tolerance)};
  trial.settings.substeps = 8;
  trial.steps = setup.steps(300, 60);
  std::mt19937 bits(3);
  trial.varying_dt = [&bits, in_turns](int step) {
    if (in_turns) return step % 2 == 0 ? 0.033 : 0.004;
    return 0.004 + 0.029 * static_cast<double>(bits()) / 4294967296.0;
  };
  const Observed observed = observe(trial);
  const double gain = observed.energy_gain / energy_of_the_swing(trial.scene);
  return outcome(std::max(0.0, gain), observed, kAnyEnergy);
}

std::vector<Case> frame_cases() {
  std::vector<Case> cases;
  for (const bool is_cotton : {false, true}) {
    for (const double tolerance : {0.01, 0.1}) {
      for (const bool in_turns : {false, true}) {
        const auto name = fmt::format("frames_{}_{}_at_{:g}", in_turns ? "in_turns" : "at_random",
                                      is_cotton ? "cotton" : "rigid", tolerance);
        cases.push_back(
            {name, "energy gained, to that of the swing", 1e-3,
             [=](const Setup& setup) { return run_frames(setup, is_cotton, tolerance, in_turns); },
             by_small_steps});
      }
    }
  }
  return cases;
}

}  // namespace

std::vector<Case> budget_cases() {
  constexpr double kMostWork = 1.3;
  std::vector<Case> cases = frame_cases();
  const auto add = [&](const std::string& name, const SceneDescription& scene, Trouble trouble) {
    cases.push_back({"budget_" + name, "work of a frame, to that of its sweeps", kMostWork,
                     [=](const Setup& setup) { return run_budget(setup, scene, trouble); },
                     by_small_steps});
  };
  for (const scenes::BuiltIn& scene : scenes::list())
    add(std::string(scene.name), sheet(scene.name, 21), Trouble::none);
  for (const std::string name : {"corners", "cape", "flag"}) {
    add(name + "_pins_part", sheet(name, 21), Trouble::pins_part);
    add(name + "_out_of_shape", sheet(name, 21), Trouble::out_of_shape);
  }
  return cases;
}

}  // namespace weft::tools::hard
