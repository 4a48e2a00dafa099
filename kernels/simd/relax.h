/// One pass over the constraints of one colour, in the displacement form (see table.h):
///
///     e = e0 + n . (u_a - u_b)
///     if |e| > threshold:  u_a += gain_a e n,  u_b += gain_b e n
///
/// Ropes keep the sum of their corrections, in units of e, at or above 0: they pull only, and an
/// early pull can be taken back.
#pragma once

#include <cmath>

#include "kernels/simd/lanes.h"

namespace weft::simd {
namespace {

struct Corrected {
  FloatMask lanes;
  Floats by;  // the error taken out of each lane, 0 where none is
};

[[gnu::always_inline]] inline Floats errors(const Relaxation& r, std::size_t c,
                                            const FloatVector& n, const FloatVector& d) {
  return fused(n.x, d.x, fused(n.y, d.y, fused(n.z, d.z, load(r.e0 + c))));
}

[[gnu::always_inline]] inline Corrected correct_distances(const Relaxation&, std::size_t, Floats e,
                                                          Floats threshold) {
  const FloatMask lanes = xsimd::abs(e) > threshold;
  return {lanes, xsimd::select(lanes, e, Floats(0.f))};
}

[[gnu::always_inline]] inline Corrected correct_ropes(const Relaxation& r, std::size_t c, Floats e,
                                                      Floats threshold) {
  const Floats sum = load(r.impulse + c);
  const Floats change = xsimd::max(e, Floats(0.f) - sum);
  const FloatMask lanes = (xsimd::abs(e) > threshold) & (change != Floats(0.f));
  const Floats by = xsimd::select(lanes, change, Floats(0.f));
  (sum + by).store_unaligned(r.impulse + c);
  return {lanes, by};
}

[[gnu::always_inline]] inline void move(FloatVector& u, const FloatVector& n, Floats by) {
  u.x = fused(by, n.x, u.x);
  u.y = fused(by, n.y, u.y);
  u.z = fused(by, n.z, u.z);
}

/// Vectors in which nothing is out of tolerance are left without a store.
template <class Correct>
[[gnu::always_inline]] inline std::uint32_t relax_contiguous(const Relaxation& r, const Run& run,
                                                             Correct&& correct) {
  const Floats threshold(r.threshold);
  std::uint32_t corrections = 0;
  for (std::size_t k = 0; k < run.length; k += kFloats) {
    const std::size_t a = run.a + k, b = run.b + k, c = run.constraint + k;
    const FloatVector n = load(r.n, c);
    FloatVector ua = load(r.u, a), ub = load(r.u, b);
    const Corrected corrected = correct(r, c, errors(r, c, n, ua - ub), threshold);
    if (!xsimd::any(corrected.lanes)) continue;
    corrections += count(corrected.lanes);
    move(ua, n, corrected.by * load(r.gain_a + c));
    move(ub, n, corrected.by * load(r.gain_b + c));
    store(r.u, a, ua);
    store(r.u, b, ub);
  }
  return corrections;
}

/// Displacements of scattered slots, brought side by side.
struct Gathered {
  alignas(64) float x[kFloats], y[kFloats], z[kFloats];

  [[gnu::always_inline]] FloatVector get(const FloatsView& u, const std::uint32_t* slot) {
    for (std::uint32_t k = 0; k < kFloats; ++k) {
      x[k] = u.x[slot[k]];
      y[k] = u.y[slot[k]];
      z[k] = u.z[slot[k]];
    }
    return {load(x), load(y), load(z)};
  }
  [[gnu::always_inline]] void put(const FloatsView& u, const std::uint32_t* slot,
                                  const FloatVector& v) {
    v.x.store_aligned(x);
    v.y.store_aligned(y);
    v.z.store_aligned(z);
    for (std::uint32_t k = 0; k < kFloats; ++k) {
      u.x[slot[k]] = x[k];
      u.y[slot[k]] = y[k];
      u.z[slot[k]] = z[k];
    }
  }
};

template <class Correct>
[[gnu::always_inline]] inline std::uint32_t relax_scattered(const Relaxation& r,
                                                            std::uint32_t first, std::uint32_t last,
                                                            Correct&& correct) {
  const Floats threshold(r.threshold);
  std::uint32_t corrections = 0;
  Gathered at_a, at_b;
  for (std::size_t c = first; c < last; c += kFloats) {
    const FloatVector n = load(r.n, c);
    FloatVector ua = at_a.get(r.u, r.a + c), ub = at_b.get(r.u, r.b + c);
    const Corrected corrected = correct(r, c, errors(r, c, n, ua - ub), threshold);
    if (!xsimd::any(corrected.lanes)) continue;
    corrections += count(corrected.lanes);
    move(ua, n, corrected.by * load(r.gain_a + c));
    move(ub, n, corrected.by * load(r.gain_b + c));
    at_a.put(r.u, r.a + c, ua);
    at_b.put(r.u, r.b + c, ub);
  }
  return corrections;
}

/// One constraint after the other: each sees what the one before it did.
template <class Change>
[[gnu::always_inline]] inline std::uint32_t relax_one_by_one(const Relaxation& r,
                                                             std::uint32_t first,
                                                             std::uint32_t last, Change&& change) {
  std::uint32_t corrections = 0;
  for (std::size_t c = first; c < last; ++c) {
    const std::size_t a = r.a[c], b = r.b[c];
    const float nx = r.n.x[c], ny = r.n.y[c], nz = r.n.z[c];
    const float e = fused(nx, r.u.x[a] - r.u.x[b],
                          fused(ny, r.u.y[a] - r.u.y[b], fused(nz, r.u.z[a] - r.u.z[b], r.e0[c])));
    const float by = std::abs(e) > r.threshold ? change(c, e) : 0;
    if (by == 0) continue;
    ++corrections;
    const float at_a = by * r.gain_a[c], at_b = by * r.gain_b[c];
    r.u.x[a] = fused(at_a, nx, r.u.x[a]);
    r.u.y[a] = fused(at_a, ny, r.u.y[a]);
    r.u.z[a] = fused(at_a, nz, r.u.z[a]);
    r.u.x[b] = fused(at_b, nx, r.u.x[b]);
    r.u.y[b] = fused(at_b, ny, r.u.y[b]);
    r.u.z[b] = fused(at_b, nz, r.u.z[b]);
  }
  return corrections;
}

std::uint32_t relax_serial(const Relaxation& r, std::uint32_t first, std::uint32_t last) {
  return relax_one_by_one(r, first, last, [](std::size_t, float e) { return e; });
}
std::uint32_t relax_rope_serial(const Relaxation& r, std::uint32_t first, std::uint32_t last) {
  return relax_one_by_one(r, first, last, [&](std::size_t c, float e) {
    const float change = e > -r.impulse[c] ? e : -r.impulse[c];
    r.impulse[c] += change;
    return change;
  });
}

std::uint32_t relax_run(const Relaxation& r, const Run& run) {
  return relax_contiguous(r, run, correct_distances);
}
std::uint32_t relax_singles(const Relaxation& r, std::uint32_t first, std::uint32_t last) {
  return relax_scattered(r, first, last, correct_distances);
}
std::uint32_t relax_rope_run(const Relaxation& r, const Run& run) {
  return relax_contiguous(r, run, correct_ropes);
}
std::uint32_t relax_rope_singles(const Relaxation& r, std::uint32_t first, std::uint32_t last) {
  return relax_scattered(r, first, last, correct_ropes);
}

}  // namespace
}  // namespace weft::simd
