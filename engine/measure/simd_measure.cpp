#include "engine/measure/simd_measure.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/bytes_of.h"
#include "engine/measure/simd_layout.h"
#include "engine/measure/state_measure.h"

namespace weft {

SimdMeasure::SimdMeasure(const Model& model, const simd::Table& table)
    : model_(model),
      layout_(model.simd()),
      table_(table),
      strains_(layout_.chunks.size()),
      stretches_(model.ordering.tiles.size() + layout_.chunks.size() / kPiece + 1) {
  if (model.constraints.has_springs()) energies_.resize(layout_.chunks.size());
}

simd::Geometry SimdMeasure::geometry(kernels::VectorsView x) const {
  return {x,       layout_.rest_length.data(), layout_.inverse_square.data(),
          nullptr, layout_.a.data(),           layout_.b.data()};
}

simd::StrainSums SimdMeasure::sums(const simd::Geometry& g, const Chunk& chunk) const {
  const std::uint32_t first = chunk.run.constraint, last = first + chunk.run.length;
  return chunk.singles ? table_.strain_singles(g, first, last, chunk.rope)
                       : table_.strain_run(g, chunk.run, chunk.rope);
}

/// The range over consecutive chunks.
simd::StretchRange SimdMeasure::stretch(const simd::Geometry& g, std::size_t first,
                                        std::size_t last) const {
  simd::StretchRange range;
  for (std::size_t end; first < last; first = end) {
    const Chunk& chunk = layout_.chunks[first];
    const auto alike = [&](const Chunk& other) {
      return !chunk.singles && !other.singles && other.rope == chunk.rope;
    };
    for (end = first + 1; end < last && alike(layout_.chunks[end]);) ++end;
    const std::uint32_t c = chunk.run.constraint;
    const simd::StretchRange part =
        chunk.singles ? table_.stretch_singles(g, c, c + chunk.run.length, chunk.rope)
                      : table_.stretch_runs(g, &layout_.runs[first], end - first, chunk.rope);
    range = {std::min(range.least, part.least), std::max(range.most, part.most)};
  }
  return range;
}

/// Rounded up by more than strain() may say for the same positions.
double SimdMeasure::max_strain(kernels::VectorsView x, Team& team, const BeforeTile& before_tile) {
  constexpr double kRounding = 1e-15;
  const simd::Geometry g = geometry(x);
  const std::vector<Tile>& tiles = model_.ordering.tiles;
  team.for_each(tiles.size(), [&](std::size_t i) {
    if (before_tile) before_tile(tiles[i].first_slot, tiles[i].last_slot);
    stretches_[i] = stretch(g, layout_.batch_chunks[tiles[i].first_batch],
                            layout_.batch_chunks[tiles[i].last_batch]);
  });
  const std::size_t tiled = tiles.empty() ? 0 : tiles.back().last_slot;
  if (before_tile && tiled < layout_.slots) before_tile(tiled, layout_.slots);
  const std::size_t between = layout_.batch_chunks[model_.ordering.between_tiles];
  const std::size_t pieces = (layout_.chunks.size() - between + kPiece - 1) / kPiece;
  team.for_each(pieces, [&](std::size_t i) {
    const std::size_t first = between + i * kPiece;
    stretches_[tiles.size() + i] =
        stretch(g, first, std::min(first + kPiece, layout_.chunks.size()));
  });
  simd::StretchRange range;
  for (std::size_t i = 0; i < tiles.size() + pieces; ++i) {
    range.least = std::min(range.least, stretches_[i].least);
    range.most = std::max(range.most, stretches_[i].most);
  }
  double most = std::max(std::sqrt(range.most) - 1, 1 - std::sqrt(range.least));
  if (most > 0) most += kRounding;
  return std::max(most, max_hub_strain(x));
}

double SimdMeasure::max_hub_strain(kernels::VectorsView x) const {
  double most = 0;
  for (std::uint32_t c = layout_.hub_first; c < layout_.hub_last; ++c) {
    most = std::max(most, strain_of(x, c));
  }
  return most;
}

std::span<const simd::StrainSums> SimdMeasure::strains_of_chunks(kernels::VectorsView x,
                                                                 Team& team) {
  const simd::Geometry g = geometry(x);
  team.for_each_part(layout_.chunks.size(), kPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) strains_[i] = sums(g, layout_.chunks[i]);
  });
  return strains_;
}

Strain SimdMeasure::strain(kernels::VectorsView x, Team& team) {
  strains_of_chunks(x, team);
  const std::size_t chunks = layout_.chunks.size();
  Strain strain;
  double squares = 0;
  std::size_t worst = chunks;
  for (std::size_t i = 0; i < chunks; ++i) {
    squares += strains_[i].squares;
    if (worst == chunks || strains_[i].largest > strain.max) {
      strain.max = strains_[i].largest;
      worst = i;
    }
  }
  finish_strain(x, worst, squares, strain);
  return strain;
}

double SimdMeasure::spring_energy(kernels::VectorsView x, double give_per_mass, Team& team) {
  const simd::Geometry g = geometry(x);
  const simd::SpringStiffness s{layout_.compliance.data(), layout_.inverse_mass.data(),
                                give_per_mass};
  team.for_each_part(layout_.chunks.size(), kPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [run, real, singles, rope] = layout_.chunks[i];
      energies_[i] = singles ? table_.spring_energy_singles(g, s, run.constraint,
                                                            run.constraint + run.length, rope)
                             : table_.spring_energy_run(g, s, run, rope);
    }
  });
  double sum = std::accumulate(energies_.begin(), energies_.end(), 0.);
  for (std::uint32_t c = layout_.hub_first; c < layout_.hub_last; ++c)
    sum += energy_of_spring(model_, x, layout_.constraint_at[c], give_per_mass);
  return sum;
}

double SimdMeasure::strain_of(kernels::VectorsView x, std::uint32_t slot) const {
  return weft::strain_of(model_, x, layout_.constraint_at[slot]);
}

/// Adds the constraints at hubs, and finds the constraint that the largest strain belongs to.
void SimdMeasure::finish_strain(kernels::VectorsView x, std::size_t worst_chunk, double squares,
                                Strain& strain) const {
  const ConstraintStore& store = model_.constraints;
  double nearest = -1;
  const auto consider = [&](std::uint32_t slot, double s) {
    if (s <= nearest) return;
    nearest = s;
    strain.worst_constraint = store.described[layout_.constraint_at[slot]];
  };
  if (worst_chunk < layout_.chunks.size()) {
    const kernels::Run& run = layout_.chunks[worst_chunk].run;
    for (std::uint32_t c = run.constraint; c < run.constraint + run.length; ++c) {
      if (layout_.constraint_at[c] != kNoIndex) consider(c, strain_of(x, c));
    }
  }
  for (std::uint32_t c = layout_.hub_first; c < layout_.hub_last; ++c) {
    const double s = strain_of(x, c);
    squares += s * s;
    strain.max = std::max(strain.max, s);
    consider(c, s);
  }
  if (store.size() > 0) strain.rms = std::sqrt(squares / static_cast<double>(store.size()));
}

std::size_t SimdMeasure::bytes() const {
  return bytes_of(strains_) + bytes_of(stretches_) + bytes_of(energies_);
}

}  // namespace weft
