/// The laws of springs in a small step, reference::ConstraintLaw, lane by lane: of single
/// constraints in blocks, and of yarns whose links may be springs.
///
/// A yarn is solved exactly, as in yarn_elimination.h. With the direction d of length l in place of
/// n, and the multiplier over l in place of the impulse, its system is
///
///     (A / omega + diag(l^2 s)) lambda = l (l - rest - q (l_start - rest) - s mu),
///     s = softness / (1 + damping),   q = damping / (1 + damping)
///
/// that is, each row divided by 1 + damping, which leaves it symmetric; l_start is the length when
/// the substep began, and mu the sum of multipliers so far. A rigid link has s = q = 0.
///
/// A sweep leaves the effect of later blocks on earlier ones. Its errors of the laws are measured
/// when the sweep is over.
#pragma once

#include "kernels/simd/quads.h"
#include "kernels/simd/yarn_elimination.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// v where a constraint is a spring, else 0.
[[gnu::always_inline]] inline Floats of_springs(Floats compliance, Floats v) {
  const Floats none(0.f);
  return xsimd::select(compliance > none, v, none);
}

/// The lengths of a vector of single constraints, now and when the substep began.
struct EdgeLengths {
  FloatVector a, b, d;  // u of the ends; d points from b to a
  Floats length, off, change;

  template <bool kDamped>
  [[gnu::always_inline]] static EdgeLengths at(const SpringRelaxation& r, std::size_t block,
                                               std::uint32_t lane) {
    QuadLanes quads;
    const EdgeBlock& edge = r.edges.blocks[block];
    const EdgeSpans& span = r.edges.spans[block];
    EdgeLengths e;
    e.a = quads.get(r.edges.u, edge.a + lane);
    e.b = quads.get(r.edges.u, edge.b + lane);
    FloatVector base = {load(span.x + lane), load(span.y + lane), load(span.z + lane)};
    e.d = base + (e.a - e.b);
    e.length = xsimd::sqrt(dot(e.d, e.d));
    e.off = e.length - load(r.springs[block].rest + lane);
    e.change = Floats(0.f);
    if constexpr (kDamped) {
      FloatVector a = quads.get(r.laws.u_start, edge.a + lane);
      FloatVector b = quads.get(r.laws.u_start, edge.b + lane);
      FloatVector start = base + (a - b);
      e.change = e.length - xsimd::sqrt(dot(start, start));
    }
    return e;
  }
};

template <bool kRope, bool kDamped>
[[gnu::always_inline]] inline void relax_springs(const SpringRelaxation& relaxation,
                                                 std::size_t first, std::size_t last) {
  const SpringRelaxation r = relaxation;  // Stores could be to what references lead to.
  QuadLanes at;
  const Floats scale(r.laws.scale), most(r.laws.most_compliance), none(0.f);
  const Floats tiny(1e-30f), looseness(1 / r.edges.omega);
  for (std::size_t i = first; i < last; ++i) {
    const EdgeBlock& block = r.edges.blocks[i];
    const SpringBlock& spring = r.springs[i];
    float* const multipliers = r.multiplier + i * kernels::kLanes;
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      EdgeLengths e = EdgeLengths::at<kDamped>(r, i, lane);
      const Floats compliance = load(spring.compliance + lane);
      const Floats damping = of_springs(compliance, Floats(r.laws.damping));
      const Floats inverse_masses = load(spring.inverse_masses + lane);
      const Floats softness = compliance * scale;
      const Floats multiplier = r.laws.continues ? load(multipliers + lane) : none;
      const Floats residual = fused_from(softness, multiplier, fused(damping, e.change, e.off));
      const Floats weight = fused(inverse_masses * looseness, damping, inverse_masses * looseness);
      Floats impulse = xsimd::select(compliance <= most, residual / (weight + softness), none);
      if constexpr (kRope) impulse = xsimd::max(impulse, none - multiplier);
      (multiplier + impulse).store_unaligned(multipliers + lane);
      const Floats q = impulse * inverse_masses / (e.length + tiny);
      at.put(r.edges.u, block.a + lane, fused(none - q * load(block.share_a + lane), e.d, e.a));
      at.put(r.edges.u, block.b + lane, fused(q * load(block.share_b + lane), e.d, e.b));
    }
  }
}

/// Which constraints break their laws by more than the tolerance, as a bit per lane.
template <bool kRope, bool kDamped>
[[gnu::always_inline]] inline void judge_springs(const SpringRelaxation& r, std::size_t first,
                                                 std::size_t last) {
  const Floats scale(r.laws.scale), most(r.laws.most_compliance), none(0.f);
  const Floats strain(r.laws.strain);
  for (std::size_t i = first; i < last; ++i) {
    const SpringBlock& spring = r.springs[i];
    std::uint32_t out = 0;
    for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
      EdgeLengths e = EdgeLengths::at<kDamped>(r, i, lane);
      const Floats compliance = load(spring.compliance + lane);
      const Floats damping = of_springs(compliance, Floats(r.laws.damping));
      const Floats pull = compliance * scale * load(r.multiplier + i * kernels::kLanes + lane);
      Floats violation = fused(damping, e.change, e.off) - pull;
      if constexpr (kRope) violation = xsimd::max(violation, none - pull);
      violation = xsimd::select(compliance <= most, xsimd::abs(violation), none);
      out |= bits(violation > strain * load(spring.rest + lane)) << lane;
    }
    r.edges.out[i] = static_cast<std::uint16_t>(out);
  }
}

/// Calls work with constants that tell whether there is damping.
template <class Work>
[[gnu::always_inline]] inline void with_damping(const SpringLaws& laws, Work&& work) {
  if (laws.damping > 0) return work(std::true_type());
  return work(std::false_type());
}

void relax_springs(const SpringRelaxation& r, bool rope, std::size_t first, std::size_t last) {
  with_damping(r.laws, [&](auto damped) {
    if (rope) return relax_springs<true, damped>(r, first, last);
    relax_springs<false, damped>(r, first, last);
  });
}
void judge_springs(const SpringRelaxation& r, bool rope, std::size_t first, std::size_t last) {
  with_damping(r.laws, [&](auto damped) {
    if (rope) return judge_springs<true, damped>(r, first, last);
    judge_springs<false, damped>(r, first, last);
  });
}

/// u of a block's particles when the substep began.
struct StartRows {
  const float* u;
  const std::uint32_t* slot;

  [[gnu::always_inline]] FloatVector get(std::uint32_t row, std::uint32_t lane) const {
    return QuadLanes().get(u, slot + std::size_t{row} * kLanes + lane);
  }
};

/// The lengths of the links of a yarn when the substep began, row after row.
template <bool kDamped>
struct StartDown {
  StartRows at;
  std::uint32_t lane;
  FloatVector here = no_vector();

  [[gnu::always_inline]] StartDown(StartRows rows, std::uint32_t first_lane)
      : at(rows), lane(first_lane) {
    if constexpr (kDamped) here = at.get(0, lane);
  }
  /// d: the present link; by: the difference of u that is in it.
  [[gnu::always_inline]] Floats length(std::uint32_t k, const FloatVector& d,
                                       const FloatVector& by) {
    FloatVector next = at.get(k + 1, lane);
    FloatVector start = d + ((here - next) - by);
    here = next;
    return xsimd::sqrt(dot(start, start));
  }
};

template <bool kDamped, Base kBase>
[[gnu::always_inline]] inline void relax_spring_block(const Yarns& yarns, const YarnBlock& block,
                                                      const QuadRows& at, const QuadRows& base,
                                                      const Scratch& all,
                                                      const YarnSpringRelaxation& relaxation) {
  const Yarns y = yarns;  // Stores could be to what references lead to.
  const YarnSpringRelaxation r = relaxation;
  const std::uint32_t first = block.first, last = rows_of(block) - 1;
  const float share = 1 / (1 + r.laws.damping), omega = r.yarns.omega;
  const Floats none(0.f), relaxed(omega);
  const Floats lag(r.laws.damping * share), most(r.laws.most_compliance);
  const Floats softness(r.laws.scale * share), weight(omega * r.laws.scale * share * r.unit_mass);
  const Floats unit_mass(r.unit_mass);
  const StartRows start{r.laws.u_start, y.slot + std::size_t{first} * kLanes};
  for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
    ScratchRow* const scratch = all.of(lane);
    float* const multiplier = r.multiplier + std::size_t{first} * kLanes + lane;
    fetch<kBase>(at, base, lane);
    Substitution substitution;
    Elimination<Along::present> elimination;
    const Floats stiff = Floats(1.f) + load(block.compliance + lane);
    StartDown<kDamped> start_down(start, lane);
    const FloatVector end = go_along<kBase>(
        y, block, at, base, lane,
        [&](std::uint32_t k, const FloatVector& here, const FloatVector& next, const FloatVector& d,
            const YarnRow& kind) __attribute__((always_inline)) {
          const Floats square = dot(d, d), length = xsimd::sqrt(square);
          const Floats rest = load(kind.rest + lane), compliance = load(kind.compliance + lane);
          Floats off = length - rest;
          if constexpr (kDamped) {
            const Floats before = start_down.length(k, d, here - next) - rest;
            off = fused_from(of_springs(compliance, lag), before, off);
          }
          if (r.laws.continues) [[unlikely]]
            off = fused_from(compliance * softness, load(multiplier + k * kLanes), off);
          const Floats joined = fused(compliance, weight, stiff * load(kind.joined + lane));
          const Floats kept = xsimd::select(compliance <= most, joined, none);
          YarnLink link{d, relaxed * length * off, square, d, off};
          at.keep(k, lane, here);
          store(scratch[k].n, d);
          substitution.take(scratch[k], link.error,
                            elimination.step(link, load(kind.inverse_mass + lane), kept));
        });
    at.keep(last, lane, end);
    go_up(
        y, block, lane, scratch, factors_in(scratch),
        [&](std::uint32_t k, Floats lambda, const FloatVector& d) __attribute__((always_inline)) {
          const Floats by = lambda * unit_mass * xsimd::sqrt(dot(d, d));
          float* const sum = multiplier + k * kLanes;
          if (r.laws.continues) [[unlikely]]
            return (load(sum) + by).store_unaligned(sum);
          by.store_unaligned(sum);
        },
        [&](std::uint32_t k, Floats w, const FloatVector& impulse) __attribute__((always_inline)) {
          at.put(k, lane, fused(w, impulse, at.kept(k, lane)));
        });
  }
}

template <bool kDamped, Base kBase>
[[gnu::always_inline]] inline void judge_spring_block(const Yarns& yarns, const YarnBlock& block,
                                                      const QuadRows& at, const QuadRows& base,
                                                      const YarnSpringRelaxation& relaxation) {
  const Yarns y = yarns;  // as above
  const YarnSpringRelaxation r = relaxation;
  const std::uint32_t first = block.first;
  const Floats none(0.f), damping(r.laws.damping), most(r.laws.most_compliance);
  const Floats softness(r.laws.scale), strain(r.laws.strain);
  const StartRows start{r.laws.u_start, y.slot + std::size_t{first} * kLanes};
  std::uint32_t* const out = r.yarns.out + first;
  for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
    const float* const multiplier = r.multiplier + std::size_t{first} * kLanes + lane;
    StartDown<kDamped> start_down(start, lane);
    go_along<kBase>(
        y, block, at, base, lane,
        [&](std::uint32_t k, const FloatVector& here, const FloatVector& next, const FloatVector& d,
            const YarnRow& kind) __attribute__((always_inline)) {
          const Floats length = xsimd::sqrt(dot(d, d));
          const Floats rest = load(kind.rest + lane), compliance = load(kind.compliance + lane);
          Floats violation =
              fused_from(compliance * softness, load(multiplier + k * kLanes), length - rest);
          if constexpr (kDamped) {
            const Floats change = length - start_down.length(k, d, here - next);
            violation = fused(of_springs(compliance, damping), change, violation);
          }
          const auto is_out = xsimd::abs(violation) > strain * rest;
          const auto is_judged = compliance <= most && load(kind.joined + lane) > none;
          const std::uint32_t lanes = bits(is_out && is_judged) << lane;
          out[k] = lane == 0 ? lanes : out[k] | lanes;
        });
  }
}

/// Calls work(whether there is damping, where base comes from, rows of u, rows of base).
template <class Work>
[[gnu::always_inline]] inline void with_spring_rows(const Yarns& y, const YarnBlock& block,
                                                    float* u, YarnScratch* scratch,
                                                    const SpringLaws& laws, Work&& work) {
  const QuadRows at{u, y.slot + std::size_t{block.first} * kLanes, Scratch(scratch, block),
                    y.from_memory};
  with_damping(laws, [&](auto damped) {
    with_base(y, block,
              [&](auto where) { work(damped, where, at, rows_of_base(y, block, at, scratch)); });
  });
}

void relax_spring_yarns(const Yarns& y, const YarnBlock& block, float* u, YarnScratch* scratch,
                        const YarnSpringRelaxation& r) {
  with_spring_rows(y, block, u, scratch, r.laws,
                   [&](auto damped, auto where, const QuadRows& at, const QuadRows& base) {
                     relax_spring_block<damped, where>(y, block, at, base, at.scratch, r);
                   });
}

void judge_spring_yarns(const Yarns& y, const YarnBlock& block, float* u, YarnScratch* scratch,
                        const YarnSpringRelaxation& r) {
  with_spring_rows(y, block, u, scratch, r.laws,
                   [&](auto damped, auto where, const QuadRows& at, const QuadRows& base) {
                     judge_spring_block<damped, where>(y, block, at, base, r);
                   });
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
