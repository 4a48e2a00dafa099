/// One pass over the constraints of one colour, in the displacement form (see sweep_data.h):
///
///     e = e0 + n . (u_a - u_b)
///     if |e| > threshold:  u_a += gain_a e n,  u_b += gain_b e n
///
/// Ropes keep the sum of their corrections, in units of e, at or above 0: they pull only, and an
/// early pull can be taken back.
#pragma once

#include <cmath>

#include "kernels/simd/quads.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

struct Corrected {
  FloatMask lanes;
  Floats by;  // the error taken out of each lane, 0 where none is
};

/// kFloats constraints of a block, from its lane on.
struct Part {
  const ConstraintBlock& block;
  std::uint32_t lane;

  [[gnu::always_inline]] FloatVector n() const {
    return {load(block.nx + lane), load(block.ny + lane), load(block.nz + lane)};
  }
  [[gnu::always_inline]] Floats e0() const { return load(block.e0 + lane); }
  [[gnu::always_inline]] Floats gain_a() const { return load(block.gain_a + lane); }
  [[gnu::always_inline]] Floats gain_b() const { return load(block.gain_b + lane); }
};

[[gnu::always_inline]] inline Part part(const BlockRelaxation& r, std::size_t c) {
  return {r.blocks[c / kernels::kLanes], static_cast<std::uint32_t>(c % kernels::kLanes)};
}

[[gnu::always_inline]] inline Floats errors(const Part& part, const FloatVector& n,
                                            const FloatVector& d) {
  return fused(n.x, d.x, fused(n.y, d.y, fused(n.z, d.z, part.e0())));
}

[[gnu::always_inline]] inline Corrected correct_distances(const BlockRelaxation&, std::size_t,
                                                          Floats e, Floats threshold) {
  const FloatMask lanes = xsimd::abs(e) > threshold;
  return {lanes, xsimd::select(lanes, e, Floats(0.f))};
}

/// Ropes pull, contacts push: the sum of their corrections stays at or above 0, at or below it.
enum class Side : std::uint8_t { pulls, pushes };

template <Side kSide>
[[gnu::always_inline]] inline Corrected correct_one_sided(const BlockRelaxation& r, std::size_t c,
                                                          Floats e, Floats threshold) {
  const Floats sum = load(r.impulse + c), back = Floats(0.f) - sum;
  Floats change = kSide == Side::pulls ? xsimd::max(e, back) : xsimd::min(e, back);
  FloatMask lanes = (xsimd::abs(e) > threshold) & (change != Floats(0.f));
  Floats by = xsimd::select(lanes, change, Floats(0.f));
  (sum + by).store_unaligned(r.impulse + c);
  return {lanes, by};
}

/// Asks for a block a few hundred nanoseconds before its turn. Runs follow each other in memory, so
/// this reaches into the next one. A pass over 1000 x 1000 particles: 1.28 ns per constraint
/// against 1.97 without (16 blocks ahead; 4: 1.64, 8: 1.42, 32: 1.24); nothing gained within the
/// caches.
[[gnu::always_inline]] inline void fetch_ahead(const ConstraintBlock& block) {
  constexpr std::size_t kBlocksAhead = 16, kCacheLine = 64;
  const auto ahead = reinterpret_cast<std::uintptr_t>(&block) + kBlocksAhead * sizeof block;
  for (std::size_t at = 0; at < sizeof block; at += kCacheLine) {
    __builtin_prefetch(reinterpret_cast<const void*>(ahead + at));
  }
}

/// Vectors in which nothing is out of tolerance are left without a store.
template <bool kFromMemory, class Correct>
[[gnu::always_inline]] inline std::uint32_t relax_contiguous(const BlockRelaxation& r,
                                                             const Run& run, Correct&& correct) {
  const Floats threshold(r.threshold);
  const Displacements u = r.u;
  std::uint32_t corrections = 0;
  for (std::size_t k = 0; k < run.length; k += kFloats) {
    const Part p = part(r, run.constraint + k);
    if (kFromMemory && p.lane == 0) fetch_ahead(p.block);
    FloatVector n = p.n();
    FloatVector ua = load(u, run.a + k), ub = load(u, run.b + k);
    Corrected corrected = correct(r, run.constraint + k, errors(p, n, ua - ub), threshold);
    if (!xsimd::any(corrected.lanes)) continue;
    corrections += count(corrected.lanes);
    ua = fused(corrected.by * p.gain_a(), n, ua);
    ub = fused(corrected.by * p.gain_b(), n, ub);
    store(u, run.a + k, ua);
    store(u, run.b + k, ub);
  }
  return corrections;
}

template <class Correct>
[[gnu::always_inline]] inline std::uint32_t relax_any_contiguous(const BlockRelaxation& r,
                                                                 const Run& run,
                                                                 Correct&& correct) {
  return r.from_memory ? relax_contiguous<true>(r, run, correct)
                       : relax_contiguous<false>(r, run, correct);
}

/// Displacements of scattered slots, planar, brought side by side. The machine's own gather and
/// scatter instructions are slower still (2.8 with gather, 3.3 with both, against 2.5 ns).
struct PlanarLanes {
  alignas(64) float x[kFloats], y[kFloats], z[kFloats];

  [[gnu::always_inline]] FloatVector get(const Displacements& u, const std::uint32_t* slot) {
    for (std::uint32_t k = 0; k < kFloats; ++k) {
      x[k] = u.x[slot[k]];
      y[k] = u.y()[slot[k]];
      z[k] = u.z()[slot[k]];
    }
    return {load(x), load(y), load(z)};
  }
  [[gnu::always_inline]] void put(const Displacements& u, const std::uint32_t* slot,
                                  const FloatVector& v) {
    v.x.store_aligned(x);
    v.y.store_aligned(y);
    v.z.store_aligned(z);
    for (std::uint32_t k = 0; k < kFloats; ++k) {
      u.x[slot[k]] = x[k];
      u.y()[slot[k]] = y[k];
      u.z()[slot[k]] = z[k];
    }
  }
};

template <class Lanes, bool kFromMemory, class Correct>
[[gnu::always_inline]] inline std::uint32_t relax_scattered(const BlockRelaxation& r,
                                                            std::uint32_t first, std::uint32_t last,
                                                            Correct&& correct) {
  const Floats threshold(r.threshold);
  std::uint32_t corrections = 0;
  Lanes at_a, at_b;
  for (std::size_t c = first; c < last; c += kFloats) {
    const Part p = part(r, c);
    if (kFromMemory && p.lane == 0) fetch_ahead(p.block);
    FloatVector n = p.n();
    FloatVector ua = at_a.get(r.u, r.a + c), ub = at_b.get(r.u, r.b + c);
    Corrected corrected = correct(r, c, errors(p, n, ua - ub), threshold);
    if (!xsimd::any(corrected.lanes)) continue;
    corrections += count(corrected.lanes);
    ua = fused(corrected.by * p.gain_a(), n, ua);
    ub = fused(corrected.by * p.gain_b(), n, ub);
    at_a.put(r.u, r.a + c, ua);
    at_b.put(r.u, r.b + c, ub);
  }
  return corrections;
}

template <class Correct>
[[gnu::always_inline]] inline std::uint32_t relax_any_scattered(const BlockRelaxation& r,
                                                                std::uint32_t first,
                                                                std::uint32_t last,
                                                                Correct&& correct) {
  if (!r.u.in_quads()) return relax_scattered<PlanarLanes, false>(r, first, last, correct);
  if (r.from_memory) return relax_scattered<QuadLanes, true>(r, first, last, correct);
  return relax_scattered<QuadLanes, false>(r, first, last, correct);
}

/// One constraint after the other: each sees what the one before it did. change(c, e): what is
/// taken out of its error.
template <class Change>
[[gnu::always_inline]] inline std::uint32_t relax_one_by_one(const BlockRelaxation& r,
                                                             std::uint32_t first,
                                                             std::uint32_t last, Change&& change) {
  float *const x = r.u.x, *const y = r.u.y(), *const z = r.u.z();
  std::uint32_t corrections = 0;
  for (std::size_t c = first; c < last; ++c) {
    const ConstraintBlock& block = r.blocks[c / kernels::kLanes];
    const std::size_t lane = c % kernels::kLanes;
    const std::size_t a = r.a[c] * r.u.step, b = r.b[c] * r.u.step;
    const float nx = block.nx[lane], ny = block.ny[lane], nz = block.nz[lane];
    const float e =
        fused(nx, x[a] - x[b], fused(ny, y[a] - y[b], fused(nz, z[a] - z[b], block.e0[lane])));
    const float by = change(c, e);
    if (by == 0) continue;
    ++corrections;
    const float at_a = by * block.gain_a[lane], at_b = by * block.gain_b[lane];
    x[a] = fused(at_a, nx, x[a]);
    y[a] = fused(at_a, ny, y[a]);
    z[a] = fused(at_a, nz, z[a]);
    x[b] = fused(at_b, nx, x[b]);
    y[b] = fused(at_b, ny, y[b]);
    z[b] = fused(at_b, nz, z[b]);
  }
  return corrections;
}

std::uint32_t relax_serial(const BlockRelaxation& r, std::uint32_t first, std::uint32_t last) {
  return relax_one_by_one(r, first, last,
                          [&](std::size_t, float e) { return std::abs(e) > r.threshold ? e : 0; });
}
std::uint32_t relax_rope_serial(const BlockRelaxation& r, std::uint32_t first, std::uint32_t last) {
  return relax_one_by_one(r, first, last, [&](std::size_t c, float e) {
    if (!(std::abs(e) > r.threshold)) return 0.f;
    const float change = e > -r.impulse[c] ? e : -r.impulse[c];
    r.impulse[c] += change;
    return change;
  });
}

std::uint32_t relax_run(const BlockRelaxation& r, const Run& run) {
  return relax_any_contiguous(r, run, correct_distances);
}
void relax_runs(const BlockRelaxation& r, const Run* runs, std::size_t count,
                const std::uint8_t* wanted, std::uint32_t* corrections) {
  const BlockRelaxation local = r;  // nothing in here can change it, as far as the compiler knows
  for (std::size_t i = 0; i < count; ++i) {
    corrections[i] = 0;
    if (wanted != nullptr && wanted[i] == 0) continue;
    corrections[i] = relax_any_contiguous(local, runs[i], correct_distances);
  }
}
std::uint32_t relax_singles(const BlockRelaxation& r, std::uint32_t first, std::uint32_t last) {
  return relax_any_scattered(r, first, last, correct_distances);
}
std::uint32_t relax_rope_run(const BlockRelaxation& r, const Run& run) {
  return relax_any_contiguous(r, run, correct_one_sided<Side::pulls>);
}
std::uint32_t relax_rope_singles(const BlockRelaxation& r, std::uint32_t first,
                                 std::uint32_t last) {
  return relax_any_scattered(r, first, last, correct_one_sided<Side::pulls>);
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
