#include "engine/step/held_apart.h"

#include <algorithm>
#include <cmath>

#include "engine/step/state.h"

namespace weft {

namespace {

/// Its strain, as a share of its rest length.
double held_strain(const State& s, const Constraint& c) {
  const auto place = [&](std::uint32_t particle) {
    return s.position[s.model->ordering.slot_of[particle]];
  };
  const double strain = length(place(c.a) - place(c.b)) / c.rest_length - 1;
  return c.kind == ConstraintKind::rope ? std::max(0.0, strain) : std::abs(strain);
}

/// A spring bears any length.
void look_at_constraints(const State& s, HeldApart& found) {
  double worst = 0;
  for (const auto& [described, c] : s.model->inert.constraints) {
    if (c.compliance > 0 || c.strength == 0) continue;
    const double strain = held_strain(s, c);
    if (strain <= s.settings.tolerance) continue;
    ++found.count;
    found.is_infeasible = true;
    if (strain > worst) found.constraint = described;
    worst = std::max(worst, strain);
  }
}

void look_at_seams(const State& s, HeldApart& found) {
  const SeamStore& seams = s.model->seams;
  double widest = 0;
  for (std::size_t i = 0; i < seams.size(); ++i) {
    const std::uint32_t a = seams.a[i], b = seams.b[i];
    if (s.model->inverse_mass[a] + s.model->inverse_mass[b] > 0) continue;
    if (seams.is_broken(i)) continue;
    const SeamState& state = s.seams.states()[i];
    const double gap = length(s.position[a] - s.position[b]);
    if (!state.is_open() || gap <= s.settings.contact_tolerance) continue;
    ++found.count;
    found.is_infeasible = found.is_infeasible || state.is_late();
    if (gap > widest) found.seam = static_cast<std::uint32_t>(i);
    widest = std::max(widest, gap);
  }
}

}  // namespace

HeldApart find_held_apart(const State& s) {
  HeldApart found;
  look_at_constraints(s, found);
  look_at_seams(s, found);
  return found;
}

}  // namespace weft
