/// predict, apply_displacements, commit and measure_impulses, in double. The formulas are those of
/// the reference (kernels/reference/integrate.h); the predicted position is formed twice, by the
/// same operations, rather than kept. Sums are kept in kLanes columns, as those of strain are
/// (measure.h).
#pragma once

#include "kernels/simd/lanes.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

[[gnu::always_inline]] inline DoubleVector acceleration(const Motion& m, std::size_t i) {
  const Doubles w = load(m.inverse_mass + i), zero(0.);
  const auto free = w > zero;
  DoubleVector a{Doubles(m.gravity.x), Doubles(m.gravity.y), Doubles(m.gravity.z)};
  if (m.force.x != nullptr) {
    a = fused(w, load(m.force, i), a);
  }
  return {xsimd::select(free, a.x, zero), xsimd::select(free, a.y, zero),
          xsimd::select(free, a.z, zero)};
}

[[gnu::always_inline]] inline DoubleVector predicted(const DoubleVector& p, const DoubleVector& v,
                                                     const DoubleVector& a, double h) {
  const Doubles step(h), half(0.5 * h * h);
  return fused(half, a, fused(step, v, p));
}

void predict(const Motion& m, double h, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; i += kDoubles) {
    store(m.solved, i, predicted(load(m.position, i), load(m.velocity, i), acceleration(m, i), h));
  }
}

/// The velocity of what solving has moved by d.
[[gnu::always_inline]] inline DoubleVector committed(const DoubleVector& v, const DoubleVector& a,
                                                     const DoubleVector& d, double h) {
  return fused(Doubles(1 / h), d, fused(Doubles(h), a, v));
}

[[gnu::always_inline]] inline DoubleMask within_range(const DoubleVector& d) {
  const Doubles most(kernels::kMost);
  return xsimd::abs(d.x) <= most && xsimd::abs(d.y) <= most && xsimd::abs(d.z) <= most;
}

/// watch(i, p, v, a, x, d, next) of each vector.
template <class Watch>
[[gnu::always_inline]] inline bool commit_and(const Motion& m, double h, std::size_t first,
                                              std::size_t last, Watch&& watch) {
  DoubleMask good(true);
  for (std::size_t i = first; i < last; i += kDoubles) {
    DoubleVector p = load(m.position, i), v = load(m.velocity, i), a = acceleration(m, i);
    DoubleVector x = load(m.solved, i);
    DoubleVector d = x - predicted(p, v, a, h);
    DoubleVector next = committed(v, a, d, h);
    store(m.next_velocity, i, next);
    good = good && within_range(x) && within_range(next);
    watch(i, p, v, a, x, d, next);
  }
  return xsimd::all(good);
}

bool commit(const Motion& m, double h, std::size_t first, std::size_t last) {
  return commit_and(m, h, first, last, [](auto&&...) {});
}

struct KickColumns {
  alignas(64) double first[kernels::kLanes] = {};
  alignas(64) double second[kernels::kLanes] = {};
  alignas(64) double gain[kernels::kLanes] = {};
  alignas(64) double energy[kernels::kLanes] = {};

  kernels::ImpulseEnergy sums() const {
    kernels::ImpulseEnergy impulses;
    for (std::uint32_t k = 0; k < kernels::kLanes; ++k) {
      impulses.add({first[k], second[k], gain[k], energy[k]});
    }
    return impulses;
  }
};

[[gnu::always_inline]] inline void add(double* column, Doubles mass, Doubles square) {
  fused(mass, square, load(column)).store_aligned(column);
}

kernels::ImpulseEnergy measure_impulses(const Motion& m, double h, std::size_t first,
                                        std::size_t last) {
  KickColumns columns;
  const Doubles rate(1 / h), two(2.), one(1.), zero(0.);
  for (std::size_t i = first; i < last; i += kDoubles) {
    DoubleVector p = load(m.position, i), v = load(m.velocity, i), a = acceleration(m, i);
    DoubleVector x = load(m.solved, i), next = load(m.next_velocity, i);
    DoubleVector d = x - predicted(p, v, a, h);
    DoubleVector kick = next - committed(v, a, d, h);
    const Doubles w = load(m.inverse_mass + i);
    const auto free = w > zero;
    const Doubles mass = xsimd::select(free, one / xsimd::select(free, w, one), zero);
    const std::size_t column = (i - first) % kernels::kLanes;
    add(columns.first + column, mass, rate * rate * dot(d, d));
    add(columns.second + column, mass, dot(kick, kick));
    const Doubles square = dot(next, next);
    add(columns.gain + column, mass, square - dot(v, v) - two * dot(a, x - p));
    add(columns.energy + column, mass, square);
  }
  return columns.sums();
}

/// commit, and the impulses of the range: while there is only one, that of positions.
bool commit_watched(const Motion& m, double h, std::size_t first, std::size_t last,
                    kernels::ImpulseEnergy& impulses) {
  constexpr std::size_t kVectors = kernels::kLanes / kDoubles;
  const Doubles rate(1 / h), two(2.), zero(0.);
  Doubles kick[kVectors], gain[kVectors], energy[kVectors];  // in registers, where there are enough
  for (std::size_t k = 0; k < kVectors; ++k) kick[k] = gain[k] = energy[k] = zero;
  bool good = true;
  for (std::size_t block = first; block < last; block += kernels::kLanes) {
#pragma GCC unroll 8
    for (std::size_t k = 0; k < kVectors; ++k) {
      const std::size_t at = block + k * kDoubles;
      good &= commit_and(
          m, h, at, at + kDoubles,
          [&](std::size_t i, const DoubleVector& p, const DoubleVector& v, const DoubleVector& a,
              const DoubleVector& x, const DoubleVector& d, const DoubleVector& next)
              __attribute__((always_inline)) {
                const auto free = load(m.inverse_mass + i) > zero;
                const Doubles mass = xsimd::select(free, load(m.mass + i), zero);
                const Doubles square = dot(next, next);
                kick[k] = fused(mass, rate * rate * dot(d, d), kick[k]);
                gain[k] = fused(mass, square - dot(v, v) - two * dot(a, x - p), gain[k]);
                energy[k] = fused(mass, square, energy[k]);
              });
    }
  }
  KickColumns columns;
  for (std::size_t k = 0; k < kVectors; ++k) {
    kick[k].store_aligned(columns.first + k * kDoubles);
    gain[k].store_aligned(columns.gain + k * kDoubles);
    energy[k].store_aligned(columns.energy + k * kDoubles);
  }
  impulses = columns.sums();
  return good;
}

void apply_quads(const kernels::VectorsView& x, float* u, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    x.x[i] += static_cast<double>(u[4 * i]);
    x.y[i] += static_cast<double>(u[4 * i + 1]);
    x.z[i] += static_cast<double>(u[4 * i + 2]);
  }
  for (std::size_t i = 4 * first; i < 4 * last; ++i) u[i] = 0;
}

void apply_displacements(kernels::VectorsView x, Displacements u, std::size_t first,
                         std::size_t last) {
  if (u.in_quads()) return apply_quads(x, u.x, first, last);
  for (std::size_t i = first; i < last; i += kDoubles) {
    DoubleVector by{load_as_double(u.x + i), load_as_double(u.y() + i), load_as_double(u.z() + i)};
    store(x, i, load(x, i) + by);
  }
  for (std::size_t i = first; i < last; i += kFloats) store(u, i, no_vector());
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
