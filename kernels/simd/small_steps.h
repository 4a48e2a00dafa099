/// The stages of a small step (engine/solvers/small_steps), in single precision.
///
/// Positions are base + u, two floats (split.h). The arrays of a Flight are laid out as u is, in
/// quads or in woven rows, so that flight is arithmetic on floats one by one. A substep of h, after
/// one of h / r, is BDF2 with variable steps,
///
///     v  = v* + (x - x*) / (b h)             velocity at the end of the last substep
///     v* = v + c (v - v_before) + b h a      prediction of this one, without constraints
///     x* = x + c (x - x_before) + b h v*
///     c = r^2 / (1 + 2 r),   b = (1 + r) / (1 + 2 r)
///
/// and with c = 0, b = 1 the implicit Euler method. (Where motion decays a acts for a share of b h:
/// engine/solvers/small_steps/small_steps.h.)
#pragma once

#include <algorithm>

#include "kernels/simd/integrate.h"
#include "kernels/simd/quads.h"
#include "kernels/simd/split.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// work(i) for each vector of floats first ... last - 1.
template <class Work>
[[gnu::always_inline]] inline void for_floats(std::size_t first, std::size_t last, Work&& work) {
  for (std::size_t i = first; i < last; i += kFloats) work(i);
}

[[gnu::always_inline]] inline Floats settled(const Flight& f, std::size_t i, Floats rate) {
  return fused(load(f.u + i) - load(f.predicted + i), rate, load(f.v + i));
}

inline float largest_lane(Floats floats) {
  alignas(64) float lanes[kFloats];
  floats.store_aligned(lanes);
  return *std::max_element(lanes, lanes + kFloats);
}

/// The largest departure of floats that are settled one after the other.
class Departure {
 public:
  explicit Departure(const LastSubstep& last) : step_(last.step), slope_(last.slope) {}

  /// f.v: still predicted.
  [[gnu::always_inline]] void add(const Flight& f, std::size_t i, Floats v) {
    const Floats v_before = load(f.v_before + i), predicted = load(f.v + i);
    const Floats led_to = fused_from(step_, load(f.acceleration + i), predicted - v_before);
    largest_ = xsimd::max(largest_, xsimd::abs(fused_from(slope_, led_to, v - v_before)));
  }
  float largest() const { return largest_lane(largest_); }

 private:
  const Floats step_, slope_;
  Floats largest_ = Floats(0.f);
};

template <bool kMeasures>
[[gnu::always_inline]] inline float advance(const Flight& flight, const SubstepWeights& weights,
                                            std::size_t first, std::size_t last) {
  const Flight f = flight;  // Stores could be to what references lead to.
  const Floats rate(weights.last.rate), c(weights.past), bh(weights.step), push(weights.push);
  Departure departure(weights.last);
  for_floats(
      first, last, [&](std::size_t i) __attribute__((always_inline)) {
        const Floats x = load(f.u + i), v = settled(f, i, rate);
        if constexpr (kMeasures) departure.add(f, i, v);
        const Floats v_next =
            fused(push, load(f.acceleration + i), fused(c, v - load(f.v_before + i), v));
        const Floats x_next = fused(bh, v_next, fused(c, x - load(f.u_before + i), x));
        x.store_unaligned(f.u_before + i);
        v.store_unaligned(f.v_before + i);
        v_next.store_unaligned(f.v + i);
        x_next.store_unaligned(f.predicted + i);
        x_next.store_unaligned(f.u + i);
      });
  return departure.largest();
}

void advance(const Flight& flight, const SubstepWeights& weights, std::size_t first,
             std::size_t last) {
  advance<false>(flight, weights, first, last);
}
float advance_measured(const Flight& flight, const SubstepWeights& weights, std::size_t first,
                       std::size_t last) {
  return advance<true>(flight, weights, first, last);
}

float settle(const Flight& flight, const LastSubstep& substep, std::size_t first,
             std::size_t last) {
  const Flight f = flight;
  Departure departure(substep);
  for_floats(
      first, last, [&](std::size_t i) __attribute__((always_inline)) {
        const Floats v = settled(f, i, Floats(substep.rate));
        departure.add(f, i, v);
        v.store_unaligned(f.v + i);
        load(f.u + i).store_unaligned(f.predicted + i);
      });
  return departure.largest();
}

float largest_move(const Flight& flight, std::size_t first, std::size_t last) {
  const Flight f = flight;
  Floats largest(0.f);
  for_floats(
      first, last, [&](std::size_t i) __attribute__((always_inline)) {
        largest = xsimd::max(largest, xsimd::abs(load(f.u + i) - load(f.u_before + i)));
      });
  return largest_lane(largest);
}

/// A change of velocity from outside between two frames changes the velocity a substep ago alike.
void resume(const Flight& flight, const Past& past, float h, std::size_t first, std::size_t last) {
  const Flight f = flight;
  const Past p = past;
  for_floats(
      first, last, [&](std::size_t i) __attribute__((always_inline)) {
        const Floats x = load(f.u + i), jump = load(f.v + i) - load(p.v + i);
        (load(p.v_before + i) + jump).store_unaligned(f.v_before + i);
        (x - fused(Floats(h), jump, load(p.moved + i))).store_unaligned(f.u_before + i);
        x.store_unaligned(f.predicted + i);
      });
}

void keep_past(const Flight& flight, const Past& past, std::size_t first, std::size_t last) {
  const Flight f = flight;
  const Past p = past;
  for_floats(
      first, last, [&](std::size_t i) __attribute__((always_inline)) {
        load(f.v + i).store_unaligned(p.v + i);
        load(f.v_before + i).store_unaligned(p.v_before + i);
        (load(f.u + i) - load(f.u_before + i)).store_unaligned(p.moved + i);
      });
}

/// Summed in kLanes columns, whatever the width of a vector.
kernels::ImpulseEnergy measure_energy_change(const Motion& m, std::size_t first, std::size_t last) {
  constexpr std::size_t kVectors = kernels::kLanes / kDoubles;
  const Doubles two(2.), zero(0.);
  Doubles gain[kVectors], energy[kVectors];
  for (std::size_t k = 0; k < kVectors; ++k) gain[k] = energy[k] = zero;
  for (std::size_t block = first; block < last; block += kernels::kLanes) {
#pragma GCC unroll 8
    for (std::size_t k = 0; k < kVectors; ++k) {
      const std::size_t i = block + k * kDoubles;
      const Doubles mass = xsimd::select(load(m.inverse_mass + i) > zero, load(m.mass + i), zero);
      DoubleVector v = load(m.velocity, i), next = load(m.next_velocity, i);
      DoubleVector way = load(m.solved, i) - load(m.position, i);
      const Doubles square = dot(next, next);
      gain[k] = fused(mass, square - dot(v, v) - two * dot(acceleration(m, i), way), gain[k]);
      energy[k] = fused(mass, square, energy[k]);
    }
  }
  alignas(64) double gains[kernels::kLanes], energies[kernels::kLanes];
  for (std::size_t k = 0; k < kVectors; ++k) {
    gain[k].store_aligned(gains + k * kDoubles);
    energy[k].store_aligned(energies + k * kDoubles);
  }
  kernels::ImpulseEnergy sum;
  for (std::size_t k = 0; k < kernels::kLanes; ++k) {
    sum.gain += gains[k];
    sum.energy += energies[k];
  }
  return sum;
}

/// Whole cells of u go into the base, which stays a whole number of them.
void renew_base(const Flight& flight, float* base, float cell, std::size_t first,
                std::size_t last) {
  const Flight f = flight;
  const Floats far(0x1.8p23f * cell);
  for_floats(
      first, last, [&](std::size_t i) __attribute__((always_inline)) {
        const Floats u = load(f.u + i), from = load(base + i), to = from + ((u + far) - far);
        const Floats by = to - from;
        to.store_unaligned(base + i);
        (u - by).store_unaligned(f.u + i);
        (load(f.predicted + i) - by).store_unaligned(f.predicted + i);
        (load(f.u_before + i) - by).store_unaligned(f.u_before + i);
      });
}

/// The part of an error that exceeds `most`, in either direction.
[[gnu::always_inline]] inline Floats beyond(Floats error, Floats most) {
  return error - xsimd::max(Floats(0.f) - most, xsimd::min(most, error));
}

void measure_edges(const EdgeBlock* blocks, EdgeSpans* spans, const float* base, std::size_t first,
                   std::size_t last) {
  QuadLanes at;
  for (std::size_t i = first; i < last; ++i) {
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      FloatVector a = at.get(base, blocks[i].a + lane), b = at.get(base, blocks[i].b + lane);
      FloatVector d = a - b;
      d.x.store_unaligned(spans[i].x + lane);
      d.y.store_unaligned(spans[i].y + lane);
      d.z.store_unaligned(spans[i].z + lane);
    }
  }
}

/// Newton's step for C = (l^2 - L^2) / 2 = 0 alone, relaxed, l^2 in its divisor replaced by the
/// mean of l^2 and L^2: the same to first order in the strain, and finite where the ends coincide.
///
///     q = omega (l^2 - L^2) / (l^2 + L^2),   x_a -= w_a / (w_a + w_b) q d,   x_b += ...
///
/// Where kLeaves the numerator is only what exceeds r.left.
template <bool kRope, bool kLeaves>
[[gnu::always_inline]] inline void relax_edges(const EdgeRelaxation& r, std::size_t first,
                                               std::size_t last) {
  QuadLanes at;
  float* const u = r.u;
  const Floats omega(r.omega), tolerance(r.tolerance), left(r.left), none(0.f);
  for (std::size_t i = first; i < last; ++i) {
    const EdgeBlock& block = r.blocks[i];
    const EdgeSpans& span = r.spans[i];
    std::uint32_t out = 0;
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      FloatVector a = at.get(u, block.a + lane), b = at.get(u, block.b + lane);
      FloatVector d =
          FloatVector{load(span.x + lane), load(span.y + lane), load(span.z + lane)} + (a - b);
      const Floats square = load(block.square + lane);
      Floats error = fused(d.x, d.x, fused(d.y, d.y, fused(d.z, d.z, none - square)));
      const Floats divisor = fused(Floats(2.f), square, error);
      if constexpr (kRope) error = xsimd::max(error, none);
      out |= bits(xsimd::abs(error) > tolerance * square) << lane;
      if constexpr (kLeaves) error = beyond(error, left * square);
      const Floats q = omega * error / divisor;
      a = fused(none - q * load(block.share_a + lane), d, a);
      b = fused(q * load(block.share_b + lane), d, b);
      at.put(u, block.a + lane, a);
      at.put(u, block.b + lane, b);
    }
    r.out[i] = static_cast<std::uint16_t>(out);
  }
}

void relax_distances(const EdgeRelaxation& r, std::size_t first, std::size_t last) {
  r.left > 0 ? relax_edges<false, true>(r, first, last) : relax_edges<false, false>(r, first, last);
}
void relax_ropes(const EdgeRelaxation& r, std::size_t first, std::size_t last) {
  r.left > 0 ? relax_edges<true, true>(r, first, last) : relax_edges<true, false>(r, first, last);
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
