/// Who is joined to whom: hubs, nobody, pieces, anything.
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "tools/studies/hard/scenes.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

/// J: every edge, its whole tolerance taken out in one step, gives its end b that speed.
double energy_of_the_tolerance(const Trial& trial) {
  double energy = 0;
  for (const Constraint& c : trial.scene.constraints) {
    const double speed = trial.settings.tolerance * c.rest_length / trial.dt;
    energy += trial.scene.masses[c.b] * speed * speed / 2;
  }
  return energy;
}

Outcome run_scene(const Setup& setup, const SceneDescription& scene, int whole, int few) {
  Trial trial{scene, setup.settings(kStrain)};
  trial.steps = setup.steps(whole, few);
  return strain_outcome(trial, energy_of_the_tolerance(trial) + 1e-9);
}

/// Random graphs may be infeasible: they must say so, and stay finite.
Outcome run_random(const Setup& setup) {
  const int graphs = setup.steps(30, 6);
  Outcome sum{0, "", {}, 0};
  int missed = 0;
  for (int seed = 1; seed <= graphs; ++seed) {
    Trial trial{random_graph(static_cast<std::uint32_t>(seed)), setup.settings(kStrain)};
    trial.settings.max_iterations = 10'000;
    trial.steps = 10;
    const Outcome one = honesty_outcome(trial, kAnyEnergy);
    sum.figure += one.figure;
    if (!one.failure.empty()) sum.failure = fmt::format("seed {}: {}", seed, one.failure);
    missed += one.detail.find("not converged") != std::string::npos;
  }
  sum.detail =
      fmt::format("{} graphs, {} of which missed the tolerance and said so", graphs, missed);
  return sum;
}

}  // namespace

std::vector<Case> graph_cases() {
  std::vector<Case> cases;
  for (const int spokes : {65, 1'000, 10'000}) {
    cases.push_back(
        {fmt::format("hub_of_{}", spokes), "max strain", kStrain, [spokes](const Setup& setup) {
           return run_scene(setup, hub(spokes), spokes > 5'000 ? 50 : 100,
                            spokes > 5'000 ? 10 : 50);
         }});
  }
  SceneDescription isolated = sheet("hang", 10);
  isolated.constraints.clear();
  SceneDescription fixed = sheet("hang", 10);
  fixed.fixed.clear();
  for (std::uint32_t i = 0; i < fixed.positions.size(); ++i) fixed.fixed.push_back(i);
  SceneDescription alone;
  alone.positions = {{0, 0, 0}};
  alone.masses = {1};
  const std::pair<const char*, SceneDescription> scenes[] = {
      {"isolated_particles", isolated},
      {"all_fixed", fixed},
      {"one_particle", alone},
      {"pieces_3000", pieces(3'000)},
  };
  for (const auto& [name, scene] : scenes) {
    cases.push_back({name, "max strain", kStrain, [scene = scene](const Setup& setup) {
                       return run_scene(setup, scene, 200, 50);
                     }});
  }
  cases.push_back({"random_graphs", "false reports", 0, run_random});
  return cases;
}

}  // namespace weft::tools::hard
