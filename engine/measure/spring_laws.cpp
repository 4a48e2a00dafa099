#include "engine/measure/spring_laws.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/bytes_of.h"

namespace weft {
namespace {

/// Softness over w_a + w_b. A spring of more moves nothing by more than doubles round.
constexpr double kSoftest = 1e20;

}  // namespace

SpringLaws::SpringLaws(const ConstraintStore& constraints) {
  for (auto* values : {&target, &softness, &tolerance, &multiplier}) {
    values->resize(constraints.size());
  }
}

void SpringLaws::begin(const Model& model, kernels::VectorsView start, double h, double share) {
  const ConstraintStore& s = model.constraints;
  begin_projection(model, std::numeric_limits<double>::infinity(), h, share);
  const double damping = model.damping.stretch / h;
  if (damping == 0) return;
  for (std::size_t c = 0; c < s.size(); ++c) {
    if (s.compliance[c] == 0) continue;
    const double stretch = length(start[s.a[c]] - start[s.b[c]]) - s.rest_length[c];
    target[c] += damping / (1 + damping) * stretch;
    softness[c] /= 1 + damping;
    tolerance[c] /= 1 + damping;
  }
}

void SpringLaws::begin_projection(const Model& model, double softest, double h, double share) {
  const ConstraintStore& s = model.constraints;
  for (std::size_t c = 0; c < s.size(); ++c) {
    target[c] = s.rest_length[c];
    tolerance[c] = share * s.rest_length[c];
    multiplier[c] = 0;
    const double most = kSoftest / s.effective_mass[c];
    const bool is_left = s.compliance[c] > softest;
    softness[c] = is_left ? most : std::min(s.compliance[c] / (h * h), most);
  }
}

std::size_t SpringLaws::bytes() const {
  return bytes_of(target) + bytes_of(softness) + bytes_of(tolerance) + bytes_of(multiplier);
}

/// A rope that is slack has no tension, whatever its length.
double largest_violation(const SpringLaws& laws, const ConstraintStore& s, kernels::VectorsView x) {
  double most = 0;
  for (std::size_t c = 0; c < s.size(); ++c) {
    const double give = laws.softness[c] * laws.multiplier[c];
    double left = length(x[s.a[c]] - x[s.b[c]]) - laws.target[c] - give;
    if (c >= s.bilateral) left = std::max(left, -give);
    if (std::isnan(left)) return std::numeric_limits<double>::infinity();
    most = std::max(most, std::abs(left) / laws.tolerance[c]);
  }
  return most;
}

/// compliance f^2 / 2
double energy_of_tensions(const SpringLaws& laws, const ConstraintStore& s, double h) {
  double sum = 0;
  for (std::size_t c = 0; c < s.size(); ++c) {
    const double tension = laws.multiplier[c] / (h * h);
    sum += 0.5 * s.compliance[c] * tension * tension;
  }
  return sum;
}

}  // namespace weft
