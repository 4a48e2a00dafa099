/// Measurements of constraints at positions. Strain, | |x_a - x_b| / rest - 1 |, in double,
/// straight from the positions, as the root of the ratio of the squares: no division. Sums are kept
/// in kLanes columns whatever the width of a vector, and added in one order: the result does not
/// depend on the instruction set. Padding has 1 / rest^2 = 0 and is left out; ropes count their
/// stretch only.
///
/// Where only the largest strain is wanted, the range of (|x_a - x_b| / rest)^2 says it, and
/// no root is taken: 0.7 to 0.85 of the time of strain_run.
#pragma once

#include <algorithm>
#include <limits>
#include <numeric>

#include "kernels/simd/directions.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

[[gnu::always_inline]] inline Doubles strain(const Geometry& g, std::size_t c,
                                             const DoubleVector& d, bool rope) {
  const Doubles inverse = load(g.inverse_square + c), zero(0.);
  const Doubles stretch = xsimd::sqrt(inverse * dot(d, d)) - Doubles(1.);
  const Doubles error = rope ? xsimd::max(stretch, zero) : xsimd::abs(stretch);
  return xsimd::select(inverse > zero, error, zero);
}

/// Measures whole blocks of kLanes. The columns stay in registers.
template <class Range>
[[gnu::always_inline]] inline StrainSums sum_strains(const Geometry& g, const Range& range,
                                                     bool rope) {
  constexpr std::size_t kVectors = kernels::kLanes / kDoubles;
  Doubles most(0.), squares[kVectors];
  std::ranges::fill(squares, Doubles(0.));
  for (std::size_t block = range.first; block < range.last; block += kernels::kLanes) {
#pragma GCC unroll 8
    for (std::size_t i = 0; i < kVectors; ++i) {
      const std::size_t c = block + i * kDoubles;
      const Doubles error = strain(g, c, range.between(g.x, c), rope);
      most = xsimd::max(most, error);
      squares[i] = fused(error, error, squares[i]);
    }
  }
  alignas(64) double largest[kDoubles], columns[kernels::kLanes];
  most.store_aligned(largest);
  for (std::size_t i = 0; i < kVectors; ++i) squares[i].store_aligned(columns + i * kDoubles);
  const auto larger = [](double x, double y) { return std::max(x, y); };
  return {std::accumulate(largest, std::end(largest), 0., larger),
          std::accumulate(columns, std::end(columns), 0.)};
}

StrainSums strain_run(const Geometry& g, const Run& run, bool rope) {
  return rope ? sum_strains(g, InRun(run), true) : sum_strains(g, InRun(run), false);
}

StrainSums strain_singles(const Geometry& g, std::uint32_t first, std::uint32_t last, bool rope) {
  const Singles singles{g, first, last};
  return rope ? sum_strains(g, singles, true) : sum_strains(g, singles, false);
}

/// Stretch^2 / (2 compliance), summed in kLanes columns as strains are.
template <class Range>
[[gnu::always_inline]] inline double sum_energies(const Geometry& g, const SpringStiffness& s,
                                                  const Range& range, bool rope) {
  constexpr std::size_t kVectors = kernels::kLanes / kDoubles;
  const Doubles give(s.give), half(0.5);
  Doubles energies[kVectors];
  std::ranges::fill(energies, Doubles(0.));
  for (std::size_t block = range.first; block < range.last; block += kernels::kLanes) {
#pragma GCC unroll 8
    for (std::size_t i = 0; i < kVectors; ++i) {
      const std::size_t c = block + i * kDoubles;
      DoubleVector d = range.between(g.x, c);
      Doubles stretch = xsimd::sqrt(dot(d, d)) - load(g.rest_length + c);
      if (rope) stretch = xsimd::max(stretch, Doubles(0.));
      const Doubles compliance = fused(give, load(s.inverse_masses + c), load(s.compliance + c));
      energies[i] = energies[i] + half * stretch * stretch / compliance;
    }
  }
  alignas(64) double columns[kernels::kLanes];
  for (std::size_t i = 0; i < kVectors; ++i) energies[i].store_aligned(columns + i * kDoubles);
  return std::accumulate(columns, std::end(columns), 0.);
}

double spring_energy_run(const Geometry& g, const SpringStiffness& s, const Run& run, bool rope) {
  return rope ? sum_energies(g, s, InRun(run), true) : sum_energies(g, s, InRun(run), false);
}

double spring_energy_singles(const Geometry& g, const SpringStiffness& s, std::uint32_t first,
                             std::uint32_t last, bool rope) {
  const Singles singles{g, first, last};
  return rope ? sum_energies(g, s, singles, true) : sum_energies(g, s, singles, false);
}

/// Largest and smallest of the numbers taken; their order does not matter. Numbers that are not
/// finite are remembered apart: among lanes a maximum may lose them.
struct StretchLanes {
  Doubles least = Doubles(1.), most = Doubles(1.);
  Doubles poison = Doubles(0.);  // 0, or not a number

  template <class Range>
  [[gnu::always_inline]] void take(const Geometry& g, const Range& range, bool rope) {
    for (std::size_t c = range.first; c < range.last; c += kDoubles) {
      DoubleVector d = range.between(g.x, c);
      const Doubles inverse = load(g.inverse_square + c), one(1.);
      const Doubles ratio = xsimd::select(inverse > Doubles(0.), inverse * dot(d, d), one);
      poison = fused(ratio, Doubles(0.), poison);
      most = xsimd::select(ratio > most, ratio, most);
      if (!rope) least = xsimd::select(ratio < least, ratio, least);
    }
  }
  StretchRange range() const {
    alignas(64) double low[kDoubles], high[kDoubles];
    least.store_aligned(low);
    most.store_aligned(high);
    alignas(64) double poisoned[kDoubles];
    poison.store_aligned(poisoned);
    const bool finite = std::ranges::all_of(poisoned, [](double p) { return p == 0; });
    return {*std::ranges::min_element(low),
            finite ? *std::ranges::max_element(high) : std::numeric_limits<double>::infinity()};
  }
};

StretchRange stretch_runs(const Geometry& g, const Run* runs, std::size_t count, bool rope) {
  StretchLanes lanes;
  for (const Run* run = runs; run != runs + count; ++run) lanes.take(g, InRun(*run), rope);
  return lanes.range();
}

StretchRange stretch_singles(const Geometry& g, std::uint32_t first, std::uint32_t last,
                             bool rope) {
  StretchLanes lanes;
  lanes.take(g, Singles{g, first, last}, rope);
  return lanes.range();
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
