#include "engine/measure/measure.h"

#include <algorithm>

#include "engine/measure/state_measure.h"

namespace weft {

Measure::Measure(const Model& model, const Settings& settings, const simd::Table& table)
    : model_(model),
      table_(table),
      tolerance_(settings.tolerance),
      contact_tolerance_(settings.contact_tolerance) {
  if (settings.backend == Backend::simd) lanes_.emplace(model, table);
}

Strain Measure::strain(kernels::VectorsView x, Team& team) {
  return lanes_ ? lanes_->strain(x, team) : measure_strain(model_, x);
}

double Measure::max_strain(kernels::VectorsView x, Team& team) {
  return lanes_ ? lanes_->max_strain(x, team) : measure_strain(model_, x).max;
}

double Measure::spring_energy(kernels::VectorsView x, double give_per_mass, Team& team) {
  if (!model_.constraints.has_springs()) return 0;
  return lanes_ ? lanes_->spring_energy(x, give_per_mass, team)
                : energy_of_springs(model_, x, give_per_mass);
}

double Measure::penetration(kernels::VectorsView x, SphereContacts& contacts) const {
  return model_.has_spheres() ? max_penetration(model_, table_, x, contacts) : 0;
}

double Measure::error(kernels::VectorsView x, const SpringLaws* laws, SphereContacts& contacts,
                      Team& team) {
  const double of_lengths = laws != nullptr ? largest_violation(*laws, model_.constraints, x)
                                            : max_strain(x, team) / tolerance_;
  return std::max(of_lengths, penetration(x, contacts) / contact_tolerance_);
}

std::size_t Measure::bytes() const { return lanes_ ? lanes_->bytes() : 0; }

}  // namespace weft
