#include "engine/measure/state_measure.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/model/bending_element.h"

namespace weft {
namespace {

/// Strains of warp, weft and shear; 0 where there is no such law.
std::array<double, reference::kMembraneLaws> strains_of(const reference::MembraneElement& e,
                                                        const reference::Deformation& f) {
  std::array<double, reference::kMembraneLaws> strains{};
  for (std::size_t k = 0; k < strains.size(); ++k) {
    if (e.stiffness[k] == 0) continue;
    const double error = term(e, f, k).error;
    strains[k] = e.is_rope && k < 2 ? std::max(0.0, error) : std::abs(error);
  }
  return strains;
}

}  // namespace

void add_membrane_strain(const Model& m, const kernels::Vectors& x, Strain& strain) {
  const MembraneStore& s = m.membrane;
  if (s.size() == 0) return;
  const auto constraints = static_cast<double>(m.constraints.size());
  double squares = constraints * strain.rms * strain.rms, most = -1;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const auto [warp, weft, shear] = strains_of(s.element[i], deformation_of(s, x, i));
    strain.max = std::max({strain.max, warp, weft});
    strain.max_shear = std::max(strain.max_shear, shear);
    squares += 0.5 * (warp * warp + weft * weft);
    if (std::max({warp, weft, shear}) <= most) continue;
    most = std::max({warp, weft, shear});
    strain.worst_element = s.described[i];
  }
  strain.rms = std::sqrt(squares / (constraints + static_cast<double>(s.size())));
}

namespace {

template <class Vectors>
Strain strain_over_all(const Model& m, const Vectors& x) {
  const ConstraintStore& s = m.constraints;
  Strain strain;
  double sum = 0;
  for (std::size_t c = 0; c < s.size(); ++c) {
    const double error = strain_of(m, x, c);
    sum += error * error;
    if (error > strain.max || strain.worst_constraint == kNoIndex) {
      strain.max = error;
      strain.worst_constraint = s.described[c];
    }
  }
  if (s.size() > 0) strain.rms = std::sqrt(sum / static_cast<double>(s.size()));
  return strain;
}

}  // namespace

Strain measure_strain(const Model& m, const kernels::Vectors& x) { return strain_over_all(m, x); }
Strain measure_strain(const Model& m, kernels::VectorsView x) { return strain_over_all(m, x); }

double energy_of_membrane(const Model& m, const kernels::Vectors& x, double give_per_mass) {
  double sum = 0;
  for (std::size_t i = 0; i < m.membrane.size(); ++i)
    sum += energy(m.membrane.element[i], deformation_of(m.membrane, x, i), give_per_mass);
  return sum;
}

double energy_of_bending(const Model& m, const kernels::Vectors& x, std::span<const Crease> creases,
                         double give_per_mass) {
  const BendingStore& s = m.bending;
  double sum = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const reference::BendingElement e = element_of(s, i, creases);
    kernels::Vector d{0, 0, 0};
    double inverse_mass = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      d = d + e.weights[k] * x[e.slots[k]];
      inverse_mass += m.inverse_mass[e.slots[k]] * e.weights[k] * e.weights[k];
    }
    const double bent = length(d) - e.rest;
    const double square = e.fold == 0 ? bent * bent : bent_square(e, x);
    sum += square / (2 * (e.compliance + give_per_mass * inverse_mass));
  }
  return sum;
}

Energy measure_energy(const Model& m, kernels::Vector gravity, const kernels::Vectors& x,
                      const kernels::Vectors& v, std::span<const Crease> creases,
                      double give_per_mass) {
  Energy energy;
  for (std::size_t i = 0; i < m.slots(); ++i) {
    if (m.inverse_mass[i] == 0) continue;
    energy.kinetic += 0.5 * m.mass[i] * dot(v[i], v[i]);
    energy.potential -= m.mass[i] * dot(gravity, x[i]);
  }
  energy.elastic = energy_of_springs(m, x, give_per_mass) +
                   energy_of_membrane(m, x, give_per_mass) +
                   energy_of_bending(m, x, creases, give_per_mass);
  return energy;
}

namespace {

using kernels::kMost;

/// In columns, which become lanes: asked one number after the other this took a fifth of a step.
bool all_numbers_finite(const kernels::AlignedVector<double>& v) {
  constexpr std::size_t kColumns = 8;
  double beyond[kColumns] = {};
  const auto judge = [&](std::size_t i, std::size_t column) {
    beyond[column] += std::abs(v[i]) <= kMost ? 0. : 1.;
  };
  const std::size_t whole = v.size() / kColumns * kColumns;
  for (std::size_t i = 0; i < whole; i += kColumns) {
    for (std::size_t column = 0; column < kColumns; ++column) judge(i + column, column);
  }
  for (std::size_t i = whole; i < v.size(); ++i) judge(i, 0);
  return std::ranges::all_of(beyond, [](double count) { return count == 0; });
}

}  // namespace

bool all_finite(const kernels::Vectors& v) {
  return all_numbers_finite(v.x) && all_numbers_finite(v.y) && all_numbers_finite(v.z);
}

std::size_t first_not_finite(const Model& m, const kernels::Vectors& x, const kernels::Vectors& v) {
  const auto within = [](double number) { return std::abs(number) <= kMost; };
  const auto finite = [&](const kernels::Vectors& vectors, std::size_t i) {
    return within(vectors.x[i]) && within(vectors.y[i]) && within(vectors.z[i]);
  };
  std::size_t any = m.slots();
  for (std::size_t i = 0; i < m.slots(); ++i) {
    if (finite(x, i) && finite(v, i)) continue;
    if (m.inverse_mass[i] > 0) return i;
    any = std::min(any, i);
  }
  return any;
}

}  // namespace weft
