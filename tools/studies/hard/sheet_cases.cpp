/// Large woven sheets: every frame converges, and none is far longer than the others.
#include <fmt/format.h>

#include "tools/studies/hard/scenes.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

constexpr double kLongestToMean = 8;

/// A sheet swings down. The fold that runs through it is at its free end with the 45th frame.
Outcome run_large(const Setup& setup, int size, double tolerance) {
  Trial trial{sheet("hang", size), setup.settings(tolerance)};
  trial.steps = setup.steps(60, 4);
  const Observed o = observe(trial);
  Outcome result = strain_outcome(o, energy_of_the_catch(size, tolerance, trial.dt));
  result.figure = 1e3 * o.longest_seconds / o.ms_per_step();
  return result;
}

}  // namespace

std::vector<Case> sheet_cases() {
  std::vector<Case> cases;
  for (const int size : {130, 160, 200, 250, 300}) {
    for (const double tolerance : {0.01, 0.002, 0.001}) {
      cases.push_back({fmt::format("hang_{}_at_{:g}", size, tolerance),
                       "time of the longest frame, to their mean", kLongestToMean,
                       [=](const Setup& setup) { return run_large(setup, size, tolerance); },
                       [](const Method& method) { return label(method) == "auto"; }});
    }
  }
  return cases;
}

}  // namespace weft::tools::hard
