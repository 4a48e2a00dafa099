/// Measurements of a state: always from positions and velocities, never from the solver.
#pragma once

#include <weft/weft.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/model/bending_element.h"
#include "engine/model/model.h"

namespace weft {

/// | |a-b| - rest | / rest of a constraint; a slack rope has none.
template <class Vectors>
double strain_of(const Model& model, const Vectors& position, std::size_t constraint) {
  const ConstraintStore& s = model.constraints;
  const double l = length(position[s.a[constraint]] - position[s.b[constraint]]);
  const double stretch = (l - s.rest_length[constraint]) / s.rest_length[constraint];
  return constraint < s.bilateral ? std::abs(stretch) : std::max(0.0, stretch);
}

template <class Vectors>
reference::Deformation deformation_of(const MembraneStore& s, const Vectors& x, std::size_t i) {
  const auto& [p0, p1, p2] = s.slots[i];
  return deformation(s.element[i].shape, x[p1] - x[p0], x[p2] - x[p0]);
}

/// Over all active constraints.
Strain measure_strain(const Model& model, const kernels::Vectors& position);
Strain measure_strain(const Model& model, kernels::VectorsView position);
/// Adds the triangles of fabric to such a strain.
void add_membrane_strain(const Model& model, const kernels::Vectors& position, Strain& strain);
/// creases: of all bending elements, where some yield. give_per_mass: of the springs, below.
Energy measure_energy(const Model& model, kernels::Vector gravity, const kernels::Vectors& position,
                      const kernels::Vectors& velocity, std::span<const Crease> creases,
                      double give_per_mass = 0);
/// J. To a sweep a spring is softer than it is: of a substep of h and a relaxation omega
/// give_per_mass is h^2 / omega, and a spring has the compliance
///
///     compliance + give_per_mass (w_a + w_b)
///
/// 0: its own. Without this what a solver leaves of a stiff spring's law would count as energy.
template <class Vectors>
double energy_of_spring(const Model& m, const Vectors& x, std::size_t c, double give_per_mass) {
  const ConstraintStore& s = m.constraints;
  if (s.compliance[c] == 0) return 0;
  const double stretch = s.rest_length[c] * strain_of(m, x, c);
  return stretch * stretch / (2 * (s.compliance[c] + give_per_mass / s.effective_mass[c]));
}
/// The sum over all springs.
template <class Vectors>
double energy_of_springs(const Model& m, const Vectors& x, double give_per_mass = 0) {
  double sum = 0;
  for (std::size_t c = 0; c < m.constraints.compliance.size(); ++c)
    sum += energy_of_spring(m, x, c, give_per_mass);
  return sum;
}
double energy_of_membrane(const Model& model, const kernels::Vectors& position,
                          double give_per_mass = 0);
double energy_of_bending(const Model& model, const kernels::Vectors& position,
                         std::span<const Crease> creases, double give_per_mass = 0);
/// Whether all components, and the squared distances between any two vectors, are finite.
bool all_finite(const kernels::Vectors& vectors);
/// The first slot of which that is not true, in x or v; a fixed one only if no free one is among
/// them. The number of slots if there is none.
std::size_t first_not_finite(const Model& model, const kernels::Vectors& x,
                             const kernels::Vectors& v);

}  // namespace weft
