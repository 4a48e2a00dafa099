/// A relaxed sweep over yarns: what a small step does to them (engine/solvers/small_steps).
///
/// As in yarn_elimination.h a yarn is solved exactly, here Newton's step for C = (l^2 - L^2) / 2 of
/// each of its constraints, whose gradient is d: no root is taken. The right side is relaxed by
/// omega; the diagonal has a compliance, the share YarnBlock::compliance of it, since the matrix of
/// a straight yarn between two fixed ends is singular. Where kLeaves the right side is only what
/// exceeds r.left.
#pragma once

#include "kernels/simd/small_steps.h"
#include "kernels/simd/yarn_elimination.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

template <bool kLeaves, Base kBase, class At>
[[gnu::always_inline]] inline void relax_block(const Yarns& y, const YarnBlock& block, At at,
                                               At base, const Scratch& all,
                                               const YarnRelaxation& r) {
  const Floats half_omega(0.5f * r.omega), tolerance(r.tolerance), left(r.left);
  std::uint32_t* const out = r.out + block.first;
  for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
    ScratchRow* scratch = all.of(lane);
    fetch<kBase>(at, base, lane);
    Substitution substitution;
    const Floats stiff = Floats(1.f) + load(block.compliance + lane);
    go_down<Along::present, kBase, false>(
        y, block, at, base, lane,
        [&](const FloatVector& d, Floats rest) __attribute__((always_inline)) {
          const Floats square = rest * rest;
          const Floats error =
              fused(d.x, d.x, fused(d.y, d.y, fused(d.z, d.z, Floats(0.f) - square)));
          const Floats taken = kLeaves ? beyond(error, left * square) : error;
          return YarnLink{d, half_omega * taken, stiff * (error + square), d, error};
        },
        [&](std::uint32_t k, const FloatVector& here, const YarnLink& link, const Factors& f)
            __attribute__((always_inline)) {
              const YarnRow& kind = kind_of(y, block.first + k);
              const std::uint32_t bad =
                  bits(xsimd::abs(link.off) > tolerance * load(kind.square + lane));
              out[k] = lane == 0 ? bad : out[k] | bad << lane;
              at.keep(k, lane, here);
              store(scratch[k].n, link.along);
              substitution.take(scratch[k], link.error, f);
            });
    go_up(
        y, block, lane, scratch, factors_in(scratch), keep_in_sums<false>(y, block, lane),
        [&](std::uint32_t k, Floats w, const FloatVector& impulse) __attribute__((always_inline)) {
          at.put(k, lane, fused(w, impulse, at.kept(k, lane)));
        });
    at.put_back(lane);
  }
}

void relax_yarns(const Yarns& y, const YarnBlock& block, float* u, YarnScratch* scratch,
                 const YarnRelaxation& relaxation) {
  with_rows(y, block, u, scratch, [&](auto at) {
    with_base(y, block, [&](auto where) {
      const auto base = rows_of_base(y, block, at, scratch);
      if (relaxation.left > 0)
        relax_block<true, where>(y, block, at, base, Scratch(scratch, block), relaxation);
      else
        relax_block<false, where>(y, block, at, base, Scratch(scratch, block), relaxation);
    });
  });
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
