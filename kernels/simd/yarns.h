/// Sweeps over yarns: each block is solved exactly (yarn_elimination.h), once, or until the errors
/// of its lengths are small enough.
#pragma once

#include "kernels/simd/yarn_elimination.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// Stores the directions at base + u for scheme rattle.
void yarn_keep_start(const Yarns& y, const YarnBlock& block, float* u, YarnScratch* scratch) {
  with_rows(y, block, u, scratch, [&](auto at) {
    const auto base = rows_of_base(y, block, at, scratch);
    const std::uint32_t last = rows_of(block) - 1;
    for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
      fetch<Base::fetched>(at, base, lane);
      RowVectors* start = start_of(y, block, lane);
      FloatVector here = at.get(0, lane), base_here = base.get(0, lane);
      for (std::uint32_t k = 0; k < last; ++k) {
        FloatVector next = at.get(k + 1, lane), base_next = base.get(k + 1, lane);
        FloatVector d = apart(y, (base_here - base_next) + (here - next));
        store(start[k], unit_link(d, load(kind_of(y, block.first + k).rest + lane)).n);
        base_here = base_next;
        here = next;
      }
      store(start[last], no_vector());
    }
  });
}

template <Along kAlong, Base kBase, bool kSprings, class At>
[[gnu::always_inline]] inline void sweep_yarns(const Yarns& y, const YarnBlock& block, At at,
                                               At base, const Scratch& all) {
  for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
    ScratchRow* scratch = all.of(lane);
    fetch<kBase>(at, base, lane);
    Substitution substitution;
    go_down<kAlong, kBase, kSprings>(
        y, block, at, base, lane, scaled_link<kAlong>,
        [&](std::uint32_t k, const FloatVector& here, const YarnLink& link, const Factors& f)
            __attribute__((always_inline)) {
              at.keep(k, lane, here);
              store(scratch[k].n, link.along);
              substitution.take(scratch[k], link.error, f);
            });
    go_up(
        y, block, lane, scratch, factors_in(scratch), keep_in_sums<kSprings>(y, block, lane),
        [&](std::uint32_t k, Floats w, const FloatVector& impulse) __attribute__((always_inline)) {
          at.put(k, lane, fused(w, impulse, at.kept(k, lane)));
        });
    at.put_back(lane);
  }
}

/// Measures the errors of lengths before a solve, as rest | length - rest |.
struct Before {
  Floats enough;
  Floats beyond = Floats(0.f);  // the most by which an error exceeds that share

  [[gnu::always_inline]] void take(const YarnLink& link, Floats rest, Floats square) {
    beyond = xsimd::max(beyond, fused_from(enough, square, rest * xsimd::abs(link.off)));
  }
};

/// The first visit of a block fetches its rows; later ones find them in place.
enum class Visit : std::uint8_t { first, again };

/// Eliminates a block forwards. Returns whether no length has an error above the share `quiet`.
template <Base kBase, Visit kVisit, bool kSprings, class At>
[[gnu::always_inline]] inline bool find_impulses(const Yarns& y, const YarnBlock& block, At at,
                                                 At base, const Scratch& all, float quiet) {
  bool is_quiet = true;
  for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
    ScratchRow* scratch = all.of(lane);
    if constexpr (kVisit == Visit::first) fetch<kBase>(at, base, lane);
    Substitution substitution;
    Before before{Floats(quiet)};
    go_down<Along::present, kBase, kSprings>(
        y, block, at, base, lane, scaled_link<Along::present>,
        [&](std::uint32_t k, const FloatVector& here, const YarnLink& link, const Factors& f)
            __attribute__((always_inline)) {
              const YarnRow& kind = kind_of(y, block.first + k);
              before.take(link, load(kind.rest + lane), load(kind.square + lane));
              at.keep(k, lane, here);
              store(scratch[k].n, link.along);
              substitution.take(scratch[k], link.error, f);
            });
    is_quiet = is_quiet && xsimd::all(before.beyond <= Floats(0.f));
  }
  return is_quiet;
}

/// The same with the differences that the last solve kept in the scratch.
template <bool kSprings>
[[gnu::always_inline]] inline void find_impulses_again(const Yarns& y, const YarnBlock& block,
                                                       const Scratch& all) {
  for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
    ScratchRow* scratch = all.of(lane);
    Substitution substitution;
    Elimination<Along::present> elimination;
    for (std::uint32_t k = 0; k + 1 < rows_of(block); ++k) {
      const YarnRow& kind = kind_of(y, block.first + k);
      YarnLink link = scaled_link<Along::present>(load(scratch[k].n), load(kind.rest + lane));
      Floats joined = load(kind.joined + lane);
      if constexpr (kSprings) joined = soften(link, y.springs[block.first + k], lane, joined);
      substitution.take(scratch[k], link.error,
                        elimination.step(link, load(kind.inverse_mass + lane), joined));
    }
  }
}

/// Measures the errors of lengths after a solve, as | length^2 - rest^2 |, which is nearly 2 rest |
/// length - rest |.
struct After {
  Floats allowed;
  Floats beyond = Floats(0.f);
  FloatVector below = no_vector();  // the motion of the next particle

  /// Takes d before the solve and the motion of the particle of the row. Returns d after the solve.
  [[gnu::always_inline]] FloatVector take(const FloatVector& d, const FloatVector& by, Floats rest,
                                          Floats square) {
    FloatVector now = d + (by - below);
    const Floats out =
        fused_from(now.x, now.x, fused_from(now.y, now.y, fused_from(now.z, now.z, rest * rest)));
    beyond = xsimd::max(beyond, fused_from(allowed, square, xsimd::abs(out)));
    below = by;
    return now;
  }
};

/// Substitutes backwards, and calls keep(row, lane, d, u) with the new values. Returns whether a
/// length has an error above the share `enough`.
template <bool kSprings, class At, class Keep>
[[gnu::always_inline]] inline bool apply_impulses(const Yarns& y, const YarnBlock& block, At at,
                                                  const Scratch& all, float enough, Keep&& keep) {
  bool out = false;
  for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
    const ScratchRow* scratch = all.of(lane);
    After after{Floats(2 * enough)};
    go_up(
        y, block, lane, scratch, factors_in(scratch), keep_in_sums<kSprings>(y, block, lane),
        [&](std::uint32_t k, Floats w, const FloatVector& impulse) __attribute__((always_inline)) {
          FloatVector u = fused(w, impulse, at.kept(k, lane));
          const YarnRow& kind = kind_of(y, block.first + k);
          Floats rest = load(kind.rest + lane);
          if constexpr (kSprings) rest = rest + give_of(y.springs[block.first + k], lane);
          keep(k, lane, after.take(load(scratch[k].n), w * impulse, rest, load(kind.square + lane)),
               u);
        });
    out = out || xsimd::any(after.beyond > Floats(0.f));
  }
  return out;
}

/// Solves a block that was solved once until its errors are within `enough`, or `most` solves are
/// done. From the third solve on everything stays in the scratch, or in place. A function of its
/// own, which both kinds of base share: it is as long as all else of such a sweep, and compiled for
/// each kind of row.
template <bool kSprings, class At>
[[gnu::noinline]] Swept solve_again(const Yarns& y, const YarnBlock& block, At at, At base,
                                    const Scratch& scratch, float enough, std::uint32_t most) {
  Yarns again = y;
  again.moved = false;
  Swept swept{1, false};
  for (; !swept.within && swept.solves < most; ++swept.solves) {
    if (swept.solves > 1) {
      find_impulses_again<kSprings>(y, block, scratch);
    } else {
      with_base(
          again, block, [&](auto where) __attribute__((always_inline)) {
            find_impulses<where, Visit::again, kSprings>(again, block, at, base, scratch, 0);
          });
    }
    swept.within = !apply_impulses<kSprings>(
        y, block, at, scratch, enough,
        [&](std::uint32_t k, std::uint32_t lane, const FloatVector& d, const FloatVector& moved)
            __attribute__((always_inline)) {
              store(scratch.of(lane)[k].n, d);
              at.keep_moved(k, lane, moved);
            });
  }
  at.put_kept(rows_of(block), lanes_of(block));
  return swept;
}

/// Solves a block until its errors are within `enough`, at most `most` times. A block whose errors
/// are below a hundredth of `enough` is not solved, because larger errors that stay come back as
/// speed. A link whose ends a solve brings together exactly is left to the next sweep.
template <Base kBase, bool kSprings, class At>
[[gnu::always_inline]] inline Swept sweep_watched(const Yarns& y, const YarnBlock& block, At at,
                                                  At base, const Scratch& scratch, float enough,
                                                  std::uint32_t most) {
  constexpr float kQuiet = 0.01f;
  if (find_impulses<kBase, Visit::first, kSprings>(y, block, at, base, scratch, kQuiet * enough)) {
    return {0, true};
  }
  const bool out = apply_impulses<kSprings>(
      y, block, at, scratch, enough,
      [&](std::uint32_t k, std::uint32_t lane, const FloatVector&, const FloatVector& moved)
          __attribute__((always_inline)) { at.put(k, lane, moved); });
  Swept swept{1, !out};
  if (out && most > 1) swept = solve_again<kSprings>(y, block, at, base, scratch, enough, most);
  for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) at.put_back(lane);
  return swept;
}

void yarn_sweep(const Yarns& y, const YarnBlock& block, float* u, YarnScratch* scratch) {
  with_rows(y, block, u, scratch, [&](auto at) {
    with_base(y, block, [&](auto where) {
      const auto base = rows_of_base(y, block, at, scratch);
      const Scratch all(scratch, block);
      if (y.start != nullptr)
        return sweep_yarns<Along::start, where, false>(y, block, at, base, all);
      with_springs(y, [&](auto springs) {
        sweep_yarns<Along::present, where, springs>(y, block, at, base, all);
      });
    });
  });
}

Swept yarn_sweep_watched(const Yarns& y, const YarnBlock& block, float* u, YarnScratch* scratch,
                         float enough, std::uint32_t most) {
  Swept swept;
  with_rows(y, block, u, scratch, [&](auto at) {
    with_base(y, block, [&](auto where) {
      const auto base = rows_of_base(y, block, at, scratch);
      with_springs(y, [&](auto springs) {
        swept = sweep_watched<where, springs>(y, block, at, base, Scratch(scratch, block), enough,
                                              most);
      });
    });
  });
  return swept;
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
