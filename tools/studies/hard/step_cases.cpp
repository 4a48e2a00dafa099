/// Steps that are long, short and not alike, and meshes that are fine for them.
#include <fmt/format.h>

#include <cmath>

#include "tools/studies/hard/scenes.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

Outcome run_hang(const Setup& setup, double dt) {
  constexpr int kSize = 20;
  Trial trial{sheet("hang", kSize), setup.settings(kStrain)};
  trial.dt = dt;
  trial.steps = setup.steps(static_cast<int>(std::min(2 / dt, 4000.0)),
                            static_cast<int>(std::min(0.6 / dt, 400.0)));
  return strain_outcome(trial, energy_of_the_catch(kSize, kStrain, dt));
}

Outcome run_varying(const Setup& setup) {
  constexpr int kSize = 20;
  constexpr double kSteps[] = {1. / 60, 1. / 100, 1. / 1000, 1. / 30, 1. / 300, 1. / 60};
  Trial trial{sheet("hang", kSize), setup.settings(kStrain)};
  trial.varying_dt = [&](int step) {
    return kSteps[static_cast<std::size_t>(step) % std::size(kSteps)];
  };
  trial.steps = setup.steps(300, 60);
  return strain_outcome(trial, energy_of_the_catch(kSize, kStrain, 1. / 30));
}

Outcome run_fine(const Setup& setup, std::string_view name, int size, int whole, int few) {
  Trial trial{sheet(name, size), setup.settings(kStrain)};
  trial.steps = setup.steps(whole, few);
  return strain_outcome(trial, kAnyEnergy);
}

}  // namespace

std::vector<Case> step_cases() {
  std::vector<Case> cases;
  for (const int rate : {30, 60, 300, 10000}) {
    cases.push_back({fmt::format("dt_1/{}", rate), "max strain", kStrain,
                     [rate](const Setup& setup) { return run_hang(setup, 1.0 / rate); }});
  }
  cases.push_back({"dt_varying", "max strain", kStrain, run_varying});
  cases.push_back({"fine_hang_160", "max strain", kStrain,
                   [](const Setup& setup) { return run_fine(setup, "hang", 160, 60, 5); }});
  cases.push_back({"fine_corners_81", "max strain", kStrain,
                   [](const Setup& setup) { return run_fine(setup, "corners", 81, 45, 5); }});
  return cases;
}

}  // namespace weft::tools::hard
