/// The true strains at given positions, in double lanes.
#pragma once

#include <weft/weft.h>

#include <functional>
#include <span>
#include <vector>

#include "engine/measure/simd_layout.h"
#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "kernels/simd/table.h"

namespace weft {

class SimdMeasure {
 public:
  SimdMeasure(const Model& model, const simd::Table& table);

  Strain strain(kernels::VectorsView x, Team& team);
  /// The sums of each chunk; valid until the next call.
  std::span<const simd::StrainSums> strains_of_chunks(kernels::VectorsView x, Team& team);
  /// The largest of constraints at hubs, which are in no chunk.
  double max_hub_strain(kernels::VectorsView x) const;
  /// Slots of a tile, before its strains are looked at; in the end those of no tile.
  using BeforeTile = std::function<void(std::size_t first, std::size_t last)>;
  /// The largest strain, and nothing besides.
  double max_strain(kernels::VectorsView x, Team& team, const BeforeTile& before_tile = {});

  /// J (energy_of_springs). Only where there are springs.
  double spring_energy(kernels::VectorsView x, double give_per_mass, Team& team);

  std::size_t bytes() const;

 private:
  simd::Geometry geometry(kernels::VectorsView x) const;
  simd::StrainSums sums(const simd::Geometry& g, const Chunk& chunk) const;
  simd::StretchRange stretch(const simd::Geometry& g, std::size_t first, std::size_t last) const;
  double strain_of(kernels::VectorsView x, std::uint32_t slot) const;
  void finish_strain(kernels::VectorsView x, std::size_t worst_chunk, double squares,
                     Strain& strain) const;

  const Model& model_;
  const SimdLayout& layout_;
  const simd::Table& table_;
  std::vector<simd::StrainSums> strains_;      // per chunk
  std::vector<double> energies_;               // likewise; of springs only
  std::vector<simd::StretchRange> stretches_;  // per tile, then per piece between tiles
};

}  // namespace weft
