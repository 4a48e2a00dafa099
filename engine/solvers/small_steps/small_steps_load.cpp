#include "engine/solvers/small_steps/small_steps_load.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/tuning.h"

namespace weft {

double substep_length(const SmallStepsLoad& load, kernels::VectorsView x, const Burden& burden,
                      double tolerance) {
  double over_slope = 1;
  for (const SmallStepsLoad::Span& span : load.spans) {
    const double distance = length(x[span.first_slot] - x[span.last_slot]);
    const double slack = std::max(0.0, span.length / distance - 1) + tolerance;
    over_slope = std::max(over_slope, 1 / std::sqrt(6 * slack));
  }
  const double more = load.held_mass > 0 ? burden.mass / load.held_mass : 0;
  const auto length_for = [&](double particles, double of_weights) {
    const double pull = 2 * of_weights * burden.acceleration * (particles + more) * over_slope;
    return pull > 0 ? std::sqrt(tuning::kOmega * tolerance * load.mean_length / pull)
                    : std::numeric_limits<double>::infinity();
  };
  const double speed = std::sqrt(2 * burden.acceleration * load.reach);
  double h = length_for(load.particles, burden.weights);
  if (speed > 0) h = std::min(h, tuning::kPassing * load.mean_length / speed);
  return h;
}

}  // namespace weft
