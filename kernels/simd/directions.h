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
  Doubles length = xsimd::sqrt(dot(d, d));
  const auto apart = length > Doubles(0.);
  const Doubles inverse = Doubles(1.) / xsimd::select(apart, length, Doubles(1.));
  return {{d.x * inverse, xsimd::select(apart, d.y * inverse, Doubles(1.)), d.z * inverse}, length};
}

[[gnu::always_inline]] inline void store_scaled(const BlockRelaxation& r, std::size_t c,
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

/// Constraints of a run, whose ends lie side by side.
struct InRun {
  std::size_t first, last;
  std::size_t a, b;  // slots of the ends of constraint c, less c

  [[gnu::always_inline]] explicit InRun(const Run& run)
      : first(run.constraint), last(first + run.length), a(run.a - first), b(run.b - first) {}
  [[gnu::always_inline]] DoubleVector between(const kernels::VectorsView& v, std::size_t c) const {
    return load(v, a + c) - load(v, b + c);
  }
};
/// Constraints whose ends lie anywhere.
struct Singles {
  const Geometry& g;
  std::size_t first, last;

  [[gnu::always_inline]] DoubleVector between(const kernels::VectorsView& v, std::size_t c) const {
    return gather(v, g.a + c) - gather(v, g.b + c);
  }
};

template <class Range>
[[gnu::always_inline]] inline void renew(const Geometry& g, const BlockRelaxation& r,
                                         const Range& range) {
  for (std::size_t c = range.first; c < range.last; c += kDoubles) {
    Direction to = direction(range.between(g.x, c));
    store_scaled(r, c, to.n, to.length - load(g.rest_length + c), load(g.scale + c));
  }
}

template <class Range>
[[gnu::always_inline]] inline void renew_from_start(const Geometry& g, kernels::VectorsView start,
                                                    const BlockRelaxation& r, const Range& range) {
  for (std::size_t c = range.first; c < range.last; c += kDoubles) {
    Doubles length = direction(range.between(g.x, c)).length;
    DoubleVector n = direction(range.between(start, c)).n;
    store_scaled(r, c, n, length - load(g.rest_length + c), load(g.scale + c));
  }
}

template <class Range>
[[gnu::always_inline]] inline void renew_velocity(const Geometry& g, kernels::VectorsView v,
                                                  const BlockRelaxation& r, const Range& range) {
  for (std::size_t c = range.first; c < range.last; c += kDoubles) {
    DoubleVector n = direction(range.between(g.x, c)).n;
    store_scaled(r, c, n, dot(n, range.between(v, c)), load(g.scale + c));
  }
}

void renew_run(const Geometry& g, const BlockRelaxation& r, const Run& run) {
  renew(g, r, InRun(run));
}
void renew_singles(const Geometry& g, const BlockRelaxation& r, std::uint32_t first,
                   std::uint32_t last) {
  renew(g, r, Singles{g, first, last});
}
void renew_from_start_run(const Geometry& g, kernels::VectorsView start, const BlockRelaxation& r,
                          const Run& run) {
  renew_from_start(g, start, r, InRun(run));
}
void renew_from_start_singles(const Geometry& g, kernels::VectorsView start,
                              const BlockRelaxation& r, std::uint32_t first, std::uint32_t last) {
  renew_from_start(g, start, r, Singles{g, first, last});
}
void renew_velocity_run(const Geometry& g, kernels::VectorsView v, const BlockRelaxation& r,
                        const Run& run) {
  renew_velocity(g, v, r, InRun(run));
}
void renew_velocity_singles(const Geometry& g, kernels::VectorsView v, const BlockRelaxation& r,
                            std::uint32_t first, std::uint32_t last) {
  renew_velocity(g, v, r, Singles{g, first, last});
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
