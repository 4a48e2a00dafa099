/// One pass over the constraints of one colour in the form of paper 4.2: errors are kept, and what
/// a correction does to its neighbours is anticipated.
///
/// The paper pushes: a correction is added to the error of every constraint that shares a particle
/// with it. Lanes of one colour would have to scatter. So each constraint pulls instead, when its
/// turn comes, what its neighbours changed since its last turn; in an order that is always the same
/// that is exactly the last change of each:
///
///     e_c += sum_k product[k] * change[from[k]]
///     change_c = |e_c| > threshold ? e_c : 0,   e_c -= change_c,   sum_c += change_c
///     product[k] = weight[k] n_c . n_from[k]
///
/// The weight is the neighbour's gain at the shared particle, negative if that is end b of c (the
/// paper prints e_j + n_j . n_i e_i, without masses and sign). A constraint that is passed over
/// must have change 0. A lane without a neighbour has weight and product 0, and pulls nothing
/// whatever it reads: what it reads may have diverged, and when others wrote it depends on the
/// width of vectors and on threads. Displacements come last: apply_sums. Where something else has
/// moved the ends, errors are formed from displacements once, and then there is nothing to pull:
/// refresh_errors.
///
///     pulls of a block of kLanes constraints in a run:   from: one number, plain loads
///     pulls of a block of singles:                       from: one number for each lane
#pragma once

#include "kernels/simd/relax.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// Where the lanes of a vector find their neighbours.
struct FromRun {
  const std::int32_t* from;
  [[gnu::always_inline]] std::size_t index(std::size_t pull, std::size_t lane) const {
    return static_cast<std::size_t>(from[pull] + static_cast<std::ptrdiff_t>(lane));
  }
  [[gnu::always_inline]] Floats get(const float* v, std::size_t pull, std::size_t lane) const {
    return load(v + from[pull] + static_cast<std::ptrdiff_t>(lane));
  }
};
struct FromSingles {
  const std::int32_t* from;
  [[gnu::always_inline]] std::size_t index(std::size_t pull, std::size_t lane) const {
    return static_cast<std::size_t>(from[pull * kernels::kLanes + lane]);
  }
  [[gnu::always_inline]] Floats get(const float* v, std::size_t pull, std::size_t lane) const {
    alignas(64) float side_by_side[kFloats];
    const std::int32_t* index = from + pull * kernels::kLanes + lane;
    for (std::uint32_t k = 0; k < kFloats; ++k) side_by_side[k] = v[index[k]];
    return load(side_by_side);
  }
};

template <class From>
[[gnu::always_inline]] inline std::uint32_t relax_anticipated(const Anticipation& p,
                                                              const From& from, std::uint32_t first,
                                                              std::uint32_t last) {
  const Floats threshold(p.threshold), none(0.f);
  std::uint32_t corrections = 0;
  for (std::size_t block = first; block < last; block += kernels::kLanes) {
    const std::size_t begin = p.first_pull[block / kernels::kLanes];
    const std::size_t end = p.first_pull[block / kernels::kLanes + 1];
    for (std::size_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      const std::size_t c = block + lane;
      Floats e = load(p.error + c);
      for (std::size_t pull = begin; pull < end; ++pull) {
        const Floats product = load(p.product + pull * kernels::kLanes + lane);
        const Floats change = from.get(p.change, pull, lane);
        e = fused(product, xsimd::select(product != none, change, none), e);
      }
      Corrected corrected = correct_distances({}, c, e, threshold);
      corrected.by.store_unaligned(p.change + c);
      (e - corrected.by).store_unaligned(p.error + c);
      (load(p.sum + c) + corrected.by).store_unaligned(p.sum + c);
      corrections += count(corrected.lanes);
    }
  }
  return corrections;
}

/// Component `axis` of the directions of kFloats constraints from c on, which stand in one block or
/// in two. note: of two, either load reads beyond what it is for, but not beyond the two blocks.
[[gnu::always_inline]] inline Floats directions_from(const BlockRelaxation& r, std::size_t c,
                                                     std::size_t axis) {
  constexpr std::size_t kLanes = kernels::kLanes, kBlock = sizeof(ConstraintBlock) / sizeof(float);
  alignas(64) static constexpr float kLane[] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                8, 9, 10, 11, 12, 13, 14, 15};
  const std::size_t first = c % kLanes;
  const float* block = &r.blocks[c / kLanes].nx[0] + axis * kLanes;
  const Floats here = load(block + first);
  if (first + kFloats <= kLanes) return here;
  const Floats next = load(block + kBlock + first - kLanes);
  return xsimd::select(load(kLane) < Floats(static_cast<float>(kLanes - first)), here, next);
}

/// The directions of the neighbours that a pull of kFloats lanes reads.
[[gnu::always_inline]] inline FloatVector directions_of(const BlockRelaxation& r,
                                                        const FromRun& from, std::size_t pull,
                                                        std::size_t lane) {
  const std::size_t c = from.index(pull, lane);
  return {directions_from(r, c, 0), directions_from(r, c, 1), directions_from(r, c, 2)};
}
[[gnu::always_inline]] inline FloatVector directions_of(const BlockRelaxation& r,
                                                        const FromSingles& from, std::size_t pull,
                                                        std::size_t lane) {
  alignas(64) float x[kFloats], y[kFloats], z[kFloats];
  for (std::uint32_t k = 0; k < kFloats; ++k) {
    const std::size_t c = from.index(pull, lane + k);
    const ConstraintBlock& block = r.blocks[c / kernels::kLanes];
    x[k] = block.nx[c % kernels::kLanes];
    y[k] = block.ny[c % kernels::kLanes];
    z[k] = block.nz[c % kernels::kLanes];
  }
  return {load(x), load(y), load(z)};
}

template <class From>
[[gnu::always_inline]] inline void renew_products(const Anticipation& p, const From& from,
                                                  const BlockRelaxation& r, std::uint32_t first,
                                                  std::uint32_t last) {
  for (std::size_t block = first; block < last; block += kernels::kLanes) {
    const std::size_t begin = p.first_pull[block / kernels::kLanes];
    const std::size_t end = p.first_pull[block / kernels::kLanes + 1];
    for (std::size_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      const std::size_t c = block + lane;
      const Part here = part(r, c);
      FloatVector n = here.n();
      for (std::size_t pull = begin; pull < end; ++pull) {
        const std::size_t k = pull * kernels::kLanes + lane;
        FloatVector other = directions_of(r, from, pull, lane);
        const Floats weight = load(p.weight + k), none(0.f);
        xsimd::select(weight != none, weight * dot(n, other), none).store_unaligned(p.product + k);
      }
      here.e0().store_unaligned(p.error + c);
      Floats(0.f).store_unaligned(p.change + c);
      Floats(0.f).store_unaligned(p.sum + c);
    }
  }
}

std::uint32_t relax_anticipated_run(const Anticipation& p, const Run& run) {
  return relax_anticipated(p, FromRun{p.from_run}, run.constraint, run.constraint + run.length);
}
std::uint32_t relax_anticipated_singles(const Anticipation& p, std::uint32_t first,
                                        std::uint32_t last) {
  return relax_anticipated(p, FromSingles{p.from_singles}, first, last);
}

void renew_products_run(const Anticipation& p, const BlockRelaxation& r, const Run& run) {
  renew_products(p, FromRun{p.from_run}, r, run.constraint, run.constraint + run.length);
}
void renew_products_singles(const Anticipation& p, const BlockRelaxation& r, std::uint32_t first,
                            std::uint32_t last) {
  renew_products(p, FromSingles{p.from_singles}, r, first, last);
}

/// The ends of kFloats constraints: side by side in a run, in lanes elsewhere.
struct RunEnds {
  const Run& run;
  [[gnu::always_inline]] FloatVector a(const BlockRelaxation& r, std::size_t c) const {
    return load(r.u, run.a + (c - run.constraint));
  }
  [[gnu::always_inline]] FloatVector b(const BlockRelaxation& r, std::size_t c) const {
    return load(r.u, run.b + (c - run.constraint));
  }
  [[gnu::always_inline]] void put(const BlockRelaxation& r, std::size_t c, const FloatVector& a,
                                  const FloatVector& b) const {
    store(r.u, run.a + (c - run.constraint), a);
    store(r.u, run.b + (c - run.constraint), b);
  }
};
template <class Lanes>
struct ScatteredEnds {
  Lanes at_a, at_b;
  [[gnu::always_inline]] FloatVector a(const BlockRelaxation& r, std::size_t c) {
    return at_a.get(r.u, r.a + c);
  }
  [[gnu::always_inline]] FloatVector b(const BlockRelaxation& r, std::size_t c) {
    return at_b.get(r.u, r.b + c);
  }
  [[gnu::always_inline]] void put(const BlockRelaxation& r, std::size_t c, const FloatVector& a,
                                  const FloatVector& b) {
    at_a.put(r.u, r.a + c, a);
    at_b.put(r.u, r.b + c, b);
  }
};

template <class Ends>
[[gnu::always_inline]] inline void apply_sums(const Anticipation& p, const BlockRelaxation& r,
                                              Ends&& ends, std::size_t first, std::size_t last) {
  for (std::size_t c = first; c < last; c += kFloats) {
    const Part here = part(r, c);
    FloatVector n = here.n();
    const Floats sum = load(p.sum + c);
    FloatVector ua = ends.a(r, c), ub = ends.b(r, c);
    ua = fused(sum * here.gain_a(), n, ua);
    ub = fused(sum * here.gain_b(), n, ub);
    ends.put(r, c, ua, ub);
    Floats(0.f).store_unaligned(p.sum + c);
  }
}

void apply_sums_run(const Anticipation& p, const BlockRelaxation& r, const Run& run) {
  apply_sums(p, r, RunEnds{run}, run.constraint, run.constraint + run.length);
}
void apply_sums_singles(const Anticipation& p, const BlockRelaxation& r, std::uint32_t first,
                        std::uint32_t last) {
  if (r.u.in_quads()) return apply_sums(p, r, ScatteredEnds<QuadLanes>{}, first, last);
  apply_sums(p, r, ScatteredEnds<PlanarLanes>{}, first, last);
}

template <class Ends>
[[gnu::always_inline]] inline void refresh_errors(const Anticipation& p, const BlockRelaxation& r,
                                                  Ends&& ends, std::size_t first,
                                                  std::size_t last) {
  for (std::size_t c = first; c < last; c += kFloats) {
    const Part here = part(r, c);
    FloatVector n = here.n();
    FloatVector ua = ends.a(r, c), ub = ends.b(r, c);
    errors(here, n, ua - ub).store_unaligned(p.error + c);
    Floats(0.f).store_unaligned(p.change + c);
  }
}

void refresh_errors_run(const Anticipation& p, const BlockRelaxation& r, const Run& run) {
  refresh_errors(p, r, RunEnds{run}, run.constraint, run.constraint + run.length);
}
void refresh_errors_singles(const Anticipation& p, const BlockRelaxation& r, std::uint32_t first,
                            std::uint32_t last) {
  if (r.u.in_quads()) return refresh_errors(p, r, ScatteredEnds<QuadLanes>{}, first, last);
  refresh_errors(p, r, ScatteredEnds<PlanarLanes>{}, first, last);
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
