/// The true errors of positions, on either backend.
#pragma once

#include <weft/weft.h>

#include <optional>

#include "engine/measure/simd_measure.h"
#include "engine/measure/spring_laws.h"
#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/spheres/sphere_contacts.h"
#include "kernels/simd/table.h"
#include "kernels/vectors.h"

namespace weft {

class Measure {
 public:
  Measure(const Model& model, const Settings& settings, const simd::Table& table);

  /// Over all active constraints.
  Strain strain(kernels::VectorsView x, Team& team);
  double max_strain(kernels::VectorsView x, Team& team);
  /// J (energy_of_springs).
  double spring_energy(kernels::VectorsView x, double give_per_mass, Team& team);
  /// m; the search writes into the scratch of the store.
  double penetration(kernels::VectorsView x, SphereContacts& contacts) const;
  /// The larger of the largest strain and the deepest penetration, each in its tolerance. With
  /// laws, what is left of them counts in place of the strain.
  double error(kernels::VectorsView x, const SpringLaws* laws, SphereContacts& contacts,
               Team& team);
  /// The measure of the simd backend.
  SimdMeasure& lanes() { return *lanes_; }
  std::size_t bytes() const;

 private:
  const Model& model_;
  const simd::Table& table_;
  const double tolerance_, contact_tolerance_;
  std::optional<SimdMeasure> lanes_;
};

}  // namespace weft
