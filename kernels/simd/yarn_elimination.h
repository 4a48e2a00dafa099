/// Yarns: chains of constraints that are solved exactly, kLanes of them at a time, one in each
/// lane.
///
/// Row k of a block holds particle k of every yarn, and the constraint that joins it to particle
/// k + 1. Along a yarn the matrix A = J M^-1 J^T of the impulses is tridiagonal,
///
///     A(k, k) = w_k + w_{k+1},     A(k, k - 1) = -c_k,     c_k = w_k n_{k-1} . n_k
///
/// and is factorised on the way down, A = L D L^T, and solved on the way up:
///
///     m_k = c_k r_{k-1},   r_k = 1 / (A(k, k) - m_k c_k),   b_k = e_k + m_k b_{k-1}
///     lambda_k = r_k b_k + m_{k+1} lambda_{k+1}
///     x_k += w_k (lambda_{k-1} n_{k-1} - lambda_k n_k)
///
/// A pivot that vanishes up to rounding belongs to a constraint that those before it imply (in a
/// straight yarn between two fixed ends), and its impulse is taken as 0. Beyond the end of a yarn,
/// or in a lane without one, the rest length of a row is 0, and so is `joined`, which holds w_k +
/// w_{k+1}: such rows have no pivot.
///
/// With scheme rattle, impulses act along s, the directions at the start of the substep, while
/// errors change along n. A = J(x) M^-1 J(q)^T is then not symmetric, but still tridiagonal,
///
///     A(k, k) = (w_k + w_{k+1}) n_k . s_k,   A(k, k - 1) = -w_k n_k . s_{k-1} = -l_k,
///     A(k - 1, k) = -w_k n_{k-1} . s_k = -c_k
///
/// so that m_k is l_k r_{k-1} on the way down, and c_k r_{k-1} on the way up.
///
/// A spring gives way: with s = compliance / h^2 and mu, the sum of its impulses in this substep,
/// A(k, k) has + s, and e_k - (target - rest) - s mu (YarnSpringRow). Kernels come with springs and
/// without.
///
/// Positions are sums base + u of two floats (yarn_rows.h). How rows find their particles:
/// yarn_places.h.
///
/// The loops handle one SIMD vector at a time: they are limited by the number of operations and not
/// by the latency of the recurrence, and two vectors at a time need too many registers.
#pragma once

#include <limits>
#include <type_traits>

#include "kernels/simd/yarn_rows.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// The least pivot, as a share of w_k + w_{k+1}. For a straight yarn between fixed ends the last
/// pivot is 0, and is computed as at most 3e-7, however long the yarn is.
constexpr float kLeastPivot = 3e-5f;
/// No smaller number has an inverse among floats.
constexpr float kLeastNormal = std::numeric_limits<float>::min();

/// Added to the y of all differences, in cells, so that ends that coincide have a direction. The
/// change is smaller than the rounding error of a length.
constexpr float kApart = 0x1p-24f;

/// The direction along which impulses act. present: that along which errors change. start: that at
/// the start of the substep. frozen: errors are also taken to change along the direction at the
/// start, so that A is symmetric and constant (yarn_system.h).
enum class Along : std::uint8_t { present, start, frozen };

struct YarnLink {
  FloatVector n;
  Floats error;
  Floats size;        // the scale of A(k, k) / (w_k + w_{k+1}): n . n, or the length of n
  FloatVector along;  // the direction of the impulse
  Floats off;         // length - rest
};

/// Returns v in lanes with a constraint, and 0 in others. On AVX-512 it uses the sign of -rest,
/// because comparisons into masks occupy the units that multiply.
[[gnu::always_inline]] inline Floats where_present(Floats rest, Floats v) {
#if defined(__AVX512F__)
  const Ints none(0), sign = (none - same_bits<Ints>(rest)) >> 31;
  return same_bits<Floats>(same_bits<Ints>(v) & sign);
#else
  const Floats none(0.f);
  return xsimd::select(rest > none, v, none);
#endif
}

/// d is the vector from particle k + 1 to particle k. If its length vanishes, any direction serves
/// to separate them.
[[gnu::always_inline]] inline YarnLink unit_link(const FloatVector& d, Floats rest) {
  const Floats one(1.f), length = xsimd::sqrt(dot(d, d));
  const auto distinct = length >= Floats(kLeastNormal);
  const Floats inverse = one / xsimd::select(distinct, length, one);
  FloatVector n{where_present(rest, inverse * d.x),
                where_present(rest, xsimd::select(distinct, inverse * d.y, one)),
                where_present(rest, inverse * d.z)};
  const Floats off = where_present(rest, length - rest);
  return {n, off, one, n, off};
}

/// The same row of the system multiplied by the length of the constraint, so that n = d and the
/// impulse is divided by the length. This saves a division. In lanes without a constraint the
/// values are arbitrary but finite.
template <Along kAlong>
[[gnu::always_inline]] inline YarnLink scaled_link(const FloatVector& d, Floats rest) {
  const Floats square = dot(d, d);
  const Floats length = xsimd::sqrt(square);
  const Floats off = length - rest;
  return {d, length * off, kAlong == Along::present ? square : length, d, off};
}

template <Along kAlong>
[[gnu::always_inline]] inline void direct(YarnLink& link, const RowVectors* start,
                                          std::uint32_t k) {
  if constexpr (kAlong == Along::present) return;
  link.along = load(start[k]);
  if constexpr (kAlong == Along::frozen) link.n = link.along;
}

[[gnu::always_inline]] inline FloatVector apart(const Yarns& y, const FloatVector& d) {
  return {d.x, d.y + Floats(kApart * y.cell), d.z};
}

/// The length beyond rest at which a row's constraint has no error.
[[gnu::always_inline]] inline Floats give_of(const YarnSpringRow& spring, std::uint32_t lane) {
  return fused(load(spring.softness + lane), load(spring.sum + lane), load(spring.shift + lane));
}

/// Takes that off the errors of a link along present directions. Returns A(k, k) in units of its
/// size.
[[gnu::always_inline]] inline Floats soften(YarnLink& link, const YarnSpringRow& spring,
                                            std::uint32_t lane, Floats joined) {
  link.off = link.off - give_of(spring, lane);
  link.error = xsimd::sqrt(link.size) * link.off;
  return joined + load(spring.softness + lane);
}

/// Adds an impulse along n to the sum of a spring.
[[gnu::always_inline]] inline void add_to_sum(YarnSpringRow& spring, std::uint32_t lane,
                                              Floats lambda, const FloatVector& n) {
  fused(lambda, xsimd::sqrt(dot(n, n)), load(spring.sum + lane)).store_unaligned(spring.sum + lane);
}

/// Whether a model has springs, as a constant.
template <class Work>
[[gnu::always_inline]] inline void with_springs(const Yarns& y, Work&& work) {
  if (y.springs != nullptr) return work(std::true_type());
  return work(std::false_type());
}

/// The factors of a row.
struct Factors {
  Floats down, up;
  FloatMask regular;
  Floats quotient;  // r where the pivot is regular

  [[gnu::always_inline]] Floats reciprocal() const {
    return xsimd::select(regular, quotient, Floats(0.f));
  }
  [[gnu::always_inline]] Floats over_pivot(Floats v) const {
    return xsimd::select(regular, quotient * v, Floats(0.f));
  }
};

/// The factorisation, row by row.
template <Along kAlong>
struct Elimination {
  FloatVector n = no_vector(), along = no_vector();  // of the previous row
  Floats quotient = Floats(0.f);                     // r where its pivot was regular
  FloatMask regular = FloatMask(false);

  /// Takes the next row. w is the inverse mass of its particle; joined is 0 where it has no
  /// constraint, and thus no pivot.
  [[gnu::always_inline]] Factors step(const YarnLink& next, Floats w, Floats joined) {
    constexpr bool kSymmetric = kAlong != Along::start;
    const Floats c = w * dot(n, next.along);
    const Floats l = kSymmetric ? c : w * dot(along, next.n);
    // Selecting products avoids that the quotient has to wait for the comparison.
    const Floats none(0.f);
    const Floats down = xsimd::select(regular, l * quotient, none);
    const Floats up = kSymmetric ? down : xsimd::select(regular, c * quotient, none);
    const Floats size = joined * next.size;
    const Floats pivot = fused_from(down, c, kSymmetric ? size : joined * dot(next.n, next.along));
    regular = pivot > fused(Floats(kLeastPivot), size, Floats(kLeastNormal));
    quotient = Floats(1.f) / pivot;
    n = next.n;
    along = next.along;
    return {down, up, regular, quotient};
  }
};

/// Calls work with a constant that tells where base comes from.
template <class Work>
[[gnu::always_inline]] inline void with_base(const Yarns& y, const YarnBlock& block, Work&& work) {
  if (remembered(y, block)) return work(std::integral_constant<Base, Base::remembered>());
  return work(std::integral_constant<Base, Base::fetched>());
}

/// Goes down the yarns, and calls take(row of the block, u of its particle, u of the next, d, kind
/// of the row) for each row but the last. The lambdas must be inlined by force, here, in go_down
/// and in go_up: GCC 12 does not inline a lambda that is called in two places, and its captures
/// then live in memory. Returns u of the last particle.
template <Base kBase, class At, class Take>
[[gnu::always_inline]] inline FloatVector go_along(const Yarns& yarns, const YarnBlock& block,
                                                   At at, At base, std::uint32_t lane,
                                                   Take&& take) {
  // A copy, since stores of vectors could change what a reference leads to.
  const Yarns y = yarns;
  const std::uint32_t first = block.first, last = rows_of(block) - 1;
  FloatVector here = at.get(0, lane);
  BaseDown<kBase, At> base_down(y, block, base, lane);
  for (std::uint32_t k = 0; k < last; ++k) {
    at.fetch_ahead(k, last, lane);
    if constexpr (kBase == Base::fetched) base.fetch_ahead(k, last, lane);
    const YarnRow& kind = kind_of(y, first + k);
    FloatVector next = at.get(k + 1, lane);
    FloatVector d = apart(y, base_down.step(k, here - next, load(kind.rest + lane)));
    take(k, here, next, d, kind);
    here = next;
  }
  base_down.end(last);
  return here;
}

/// A row without a constraint, behind the last.
[[gnu::always_inline]] inline YarnLink no_link() {
  const Floats none(0.f);
  return {no_vector(), none, none, no_vector(), none};
}
[[gnu::always_inline]] inline Factors no_factors() {
  const Floats none(0.f);
  return {none, none, FloatMask(false), none};
}

/// Goes down the yarns, and calls take(row of the block, u of its particle, link, factors) for each
/// row, where link = make_link(d, rest).
template <Along kAlong, Base kBase, bool kSprings, class At, class MakeLink, class Take>
[[gnu::always_inline]] inline void go_down(const Yarns& yarns, const YarnBlock& block, At at,
                                           At base, std::uint32_t lane, MakeLink&& make_link,
                                           Take&& take) {
  const Yarns y = yarns;  // as in go_along
  Elimination<kAlong> elimination;
  const RowVectors* start = start_of(y, block, lane);
  const FloatVector last = go_along<kBase>(
      y, block, at, base, lane,
      [&](std::uint32_t k, const FloatVector& here, const FloatVector&, const FloatVector& d,
          const YarnRow& kind) __attribute__((always_inline)) {
        YarnLink link = make_link(d, load(kind.rest + lane));
        direct<kAlong>(link, start, k);
        Floats joined = load(kind.joined + lane);
        if constexpr (kSprings) joined = soften(link, y.springs[block.first + k], lane, joined);
        take(k, here, link, elimination.step(link, load(kind.inverse_mass + lane), joined));
      });
  take(rows_of(block) - 1, last, no_link(), no_factors());
}

/// The factors of a row that the back substitution needs.
struct RowFactors {
  FloatVector n;
  Floats m;
};
[[gnu::always_inline]] inline auto factors_in(const ScratchRow* scratch) {
  return [=](std::uint32_t k) __attribute__((always_inline)) {
    return RowFactors{load(scratch[k].n), load(scratch[k].m)};
  };
}

/// go_up adds the impulses of springs to their sums.
template <bool kSprings>
[[gnu::always_inline]] inline auto keep_in_sums(const Yarns& y, const YarnBlock& block,
                                                std::uint32_t lane) {
  if constexpr (kSprings) {
    return [ springs = y.springs + block.first, lane ](
        std::uint32_t k, Floats lambda, const FloatVector& n) __attribute__((always_inline)) {
      add_to_sum(springs[k], lane, lambda, n);
    };
  } else {
    return [](std::uint32_t, Floats, const FloatVector&) __attribute__((always_inline)){};
  }
}

/// Goes up the yarns, and calls move(row of the block, its inverse mass, the sum of its impulses).
/// factors(row) returns n and m. keep(row, impulse, n) is called for each constraint, before move
/// is called for the row after it.
template <class GetFactors, class Keep, class Move>
[[gnu::always_inline]] inline void go_up(const Yarns& yarns, const YarnBlock& block,
                                         std::uint32_t lane, const ScratchRow* scratch,
                                         GetFactors&& factors, Keep&& keep, Move&& move) {
  const Yarns y = yarns;  // as in go_down
  const std::uint32_t first = block.first;
  FloatVector below = no_vector();  // impulse of the constraint to the next row
  Floats lambda(0.f), m(0.f);
  for (std::uint32_t k = rows_of(block) - 1; k > 0; --k) {
    lambda = fused(m, lambda, load(scratch[k - 1].y));
    RowFactors row = factors(k - 1);
    m = row.m;
    FloatVector above = lambda * row.n;
    keep(k - 1, lambda, row.n);
    move(k, load(kind_of(y, first + k).inverse_mass + lane), above - below);
    below = above;
  }
  move(0, load(kind_of(y, first).inverse_mass + lane), no_vector() - below);
}

/// The forward elimination of the right side.
struct Substitution {
  Floats b = Floats(0.f);

  [[gnu::always_inline]] void take(ScratchRow& row, Floats error, const Factors& f) {
    b = fused(f.down, b, error);
    f.up.store_unaligned(row.m);
    f.over_pivot(b).store_unaligned(row.y);
  }
};

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
