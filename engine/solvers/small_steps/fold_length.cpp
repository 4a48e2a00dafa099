#include "engine/solvers/small_steps/fold_length.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "engine/model/bending_element.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/tuning.h"

namespace weft {
namespace {

/// The sine of half the angle at rest, if its faces are as long as now.
double sine_of(const reference::BendingElement& e, kernels::VectorsView x) {
  const kernels::Vector edge = x[e.slots[1]] - x[e.slots[0]];
  const double along = length(edge);
  double reach = 0;
  for (const std::size_t k : {std::size_t{2}, std::size_t{3}})
    reach += std::abs(e.weights[k]) * length(cross(edge, x[e.slots[k]] - x[e.slots[0]]));
  const double fold = along * std::abs(e.fold);
  return fold < reach ? fold / reach : 1;
}

}  // namespace

double substep_length_for_folds(const Model& model, std::span<const Crease> creases,
                                kernels::VectorsView x) {
  double least = std::numeric_limits<double>::infinity();
  if (model.small_steps().bending.folds.empty()) return least;
  for (std::size_t i = 0; i < model.bending.size(); ++i) {
    const reference::BendingElement e = element_of(model.bending, i, creases);
    if (e.fold == 0) continue;
    const double w = inverse_mass_of(e, model.inverse_mass.data()), sine = sine_of(e, x);
    if (w > 0) least = std::min(least, std::sqrt(e.compliance / w) / (sine * sine));
  }
  return tuning::kFoldTurn * least;
}

}  // namespace weft
