/// Directions and errors, in double, rounded once to float (paper 4.2):
///
///     d = x_a - x_b,  l = |d|,  n = d / l / tau,  e0 = (l - rest) / tau
///
/// Scheme rattle takes n at the positions that the step started from, and e0 from x all the same.
/// Ends that coincide have no direction; any separates them: n = (0, 1, 0) / tau.
#pragma once

#include "kernels/simd/lanes.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

struct Direction {
  DoubleVector n;  // unit
  Doubles length;
};

[[gnu::always_inline]] inline Direction direction(const DoubleVector& d) {
  const Doubles length = xsimd::sqrt(dot(d, d));
  const auto apart = length > Doubles(0.);
  const Doubles inverse = Doubles(1.) / xsimd::select(apart, length, Doubles(1.));
  return {{d.x * inverse, xsimd::select(apart, d.y * inverse, Doubles(1.)), d.z * inverse}, length};
}

[[gnu::always_inline]] inline void store_scaled(const Relaxation& r, std::size_t c,
                                                const DoubleVector& n, Doubles error,
                                                Doubles scale) {
  ConstraintBlock& block = r.blocks[c / kernels::kLanes];
  const std::size_t lane = c % kernels::kLanes;
  store_as_float(block.nx + lane, n.x * scale);
  store_as_float(block.ny + lane, n.y * scale);
  store_as_float(block.nz + lane, n.z * scale);
  store_as_float(block.e0 + lane, error * scale);
}

/// The doubles of scattered slots, brought side by side.
[[gnu::always_inline]] inline DoubleVector gather(const kernels::VectorsView& v,
                                                  const std::uint32_t* slot) {
  alignas(64) double x[kDoubles], y[kDoubles], z[kDoubles];
  for (std::uint32_t k = 0; k < kDoubles; ++k) {
    x[k] = v.x[slot[k]];
    y[k] = v.y[slot[k]];
    z[k] = v.z[slot[k]];
  }
  return {load(x), load(y), load(z)};
}

[[gnu::always_inline]] inline void renew(const Geometry& g, const Relaxation& r, std::size_t c,
                                         const DoubleVector& d) {
  const Direction to = direction(d);
  store_scaled(r, c, to.n, to.length - load(g.rest_length + c), load(g.scale + c));
}

[[gnu::always_inline]] inline void renew_from_start(const Geometry& g, const Relaxation& r,
                                                    std::size_t c, const DoubleVector& d,
                                                    const DoubleVector& start) {
  const Doubles length = xsimd::sqrt(dot(d, d));
  store_scaled(r, c, direction(start).n, length - load(g.rest_length + c), load(g.scale + c));
}

[[gnu::always_inline]] inline void renew_velocity(const Geometry& g, const Relaxation& r,
                                                  std::size_t c, const DoubleVector& d,
                                                  const DoubleVector& dv) {
  const Direction to = direction(d);
  store_scaled(r, c, to.n, dot(to.n, dv), load(g.scale + c));
}

void renew_run(const Geometry& g, const Relaxation& r, const Run& run) {
  for (std::size_t k = 0; k < run.length; k += kDoubles) {
    renew(g, r, run.constraint + k, load(g.x, run.a + k) - load(g.x, run.b + k));
  }
}

void renew_singles(const Geometry& g, const Relaxation& r, std::uint32_t first,
                   std::uint32_t last) {
  for (std::size_t c = first; c < last; c += kDoubles) {
    renew(g, r, c, gather(g.x, g.a + c) - gather(g.x, g.b + c));
  }
}

void renew_from_start_run(const Geometry& g, kernels::VectorsView start, const Relaxation& r,
                          const Run& run) {
  for (std::size_t k = 0; k < run.length; k += kDoubles) {
    const std::size_t a = run.a + k, b = run.b + k;
    renew_from_start(g, r, run.constraint + k, load(g.x, a) - load(g.x, b),
                     load(start, a) - load(start, b));
  }
}

void renew_from_start_singles(const Geometry& g, kernels::VectorsView start, const Relaxation& r,
                              std::uint32_t first, std::uint32_t last) {
  for (std::size_t c = first; c < last; c += kDoubles) {
    renew_from_start(g, r, c, gather(g.x, g.a + c) - gather(g.x, g.b + c),
                     gather(start, g.a + c) - gather(start, g.b + c));
  }
}

void renew_velocity_run(const Geometry& g, kernels::VectorsView v, const Relaxation& r,
                        const Run& run) {
  for (std::size_t k = 0; k < run.length; k += kDoubles) {
    const std::size_t a = run.a + k, b = run.b + k;
    renew_velocity(g, r, run.constraint + k, load(g.x, a) - load(g.x, b), load(v, a) - load(v, b));
  }
}

void renew_velocity_singles(const Geometry& g, kernels::VectorsView v, const Relaxation& r,
                            std::uint32_t first, std::uint32_t last) {
  for (std::size_t c = first; c < last; c += kDoubles) {
    renew_velocity(g, r, c, gather(g.x, g.a + c) - gather(g.x, g.b + c),
                   gather(v, g.a + c) - gather(v, g.b + c));
  }
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
