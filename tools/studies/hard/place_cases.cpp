/// The same cloth very small, very large and very far away.
#include <cmath>

#include "tools/studies/hard/scenes.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

constexpr double kTightStrain = 0.001;

/// Steps grow with the square root of the size, so that the motion is the same.
Outcome run_scaled(const Setup& setup, double scale) {
  Trial trial{sheet("hang", 20), setup.settings(kTightStrain)};
  for (Vec3& position : trial.scene.positions) position = scale * position;
  for (Constraint& constraint : trial.scene.constraints) constraint.rest_length *= scale;
  trial.dt = 0.01 * std::sqrt(scale);
  trial.steps = setup.steps(200, 50);
  return strain_outcome(trial, 1e-3 * scale);
}

Outcome run_far(const Setup& setup, double distance) {
  Trial trial{sheet("hang", 20), setup.settings(kTightStrain)};
  const Vec3 away{distance, -distance, distance};
  for (Vec3& position : trial.scene.positions) position = position + away;
  trial.steps = setup.steps(200, 50);
  return strain_outcome(trial, 1e-3);
}

}  // namespace

std::vector<Case> place_cases() {
  std::vector<Case> cases;
  for (const auto& [name, scale] : {std::pair{"scale_1_mm", 1e-3}, {"scale_1_km", 1e3}}) {
    cases.push_back({name, "max strain", kTightStrain,
                     [scale = scale](const Setup& setup) { return run_scaled(setup, scale); }});
  }
  for (const auto& [name, distance] : {std::pair{"far_1e4_m", 1e4}, {"far_1e6_m", 1e6}}) {
    cases.push_back({name, "max strain", kTightStrain, [distance = distance](const Setup& setup) {
                       return run_far(setup, distance);
                     }});
  }
  return cases;
}

}  // namespace weft::tools::hard
