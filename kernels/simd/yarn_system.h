/// The linear system of all yarns, for conjugate gradients (engine/solvers/yarn/yarn_solver.h).
/// Divided by families, the matrix A of all constraints is
///
///     | T_0  C   |     T_f   tridiagonal: the yarns of family f, which are solved exactly
///     | C^T  R   |     C     the coupling of the first family with all others
///                      R     all other families, with blockdiag(T_1, T_2, ...) as preconditioner
///
/// The first family is eliminated, and conjugate gradients solve with the Schur complement S = R -
/// C^T T_0^-1 C. With two families this takes half of the iterations that A takes with
/// blockdiag(T_0, T_1), for the same work in each, because A has property A (Reid 1972).
///
/// S p is computed without the entries of S. The impulses p move the particles by t = M^-1 J^T p
/// (yarn_push, one family after the other). The impulses of the first family restore its lengths, t
/// -= M^-1 J_0^T T_0^-1 J_0 t (yarn_eliminate), and each other constraint then finds its change J t
/// (yarn_pull). With the errors of the first family included, the elimination gives the right side
/// of the reduced system, and in the end the impulses of the first family.
///
/// Springs have their softness on the diagonal of each T_f and R (yarn_elimination.h).
///
/// With scheme rattle A = J(q) M^-1 J(q)^T has the directions q at the start of the substep. It is
/// symmetric, but ignores what constraints have turned by since. Each Newton step (of the
/// simplified Newton method) leaves that part of the error, which the sweep after it, whose
/// tridiagonal matrices are exact, reduces.
///
/// Velocities have the same system, with the directions and factors of the positions and the right
/// side J v (yarn_read).
#pragma once

#include <algorithm>

#include "kernels/simd/yarn_elimination.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

[[gnu::always_inline]] inline float sum(const float* lanes) {
  float total = 0;
  for (std::uint32_t k = 0; k < kLanes; ++k) total += lanes[k];
  return total;
}

/// The larger of two absolute values. A NaN may be lost, but the sums have it too.
[[gnu::always_inline]] inline Floats larger(Floats most, Floats v) {
  return xsimd::select(xsimd::abs(v) <= most, most, xsimd::abs(v));
}
[[gnu::always_inline]] inline float larger(float most, Floats v) {
  alignas(64) float lanes[kFloats];
  v.store_aligned(lanes);
  for (const float lane : lanes) most = lane <= most ? most : lane;
  return most;
}

template <Along kAlong, Base kBase, bool kSprings, class At>
[[gnu::always_inline]] inline void linearise_yarns(const Yarns& y, const YarnBlock& block, At at,
                                                   At base) {
  for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
    fetch<kBase>(at, base, lane);
    SystemRow* system = system_of(y, block, lane);
    const Floats zero(0.f);
    go_down<kAlong, kBase, kSprings>(
        y, block, at, base, lane, unit_link,
        [&](std::uint32_t k, const FloatVector&, const YarnLink& link, const Factors& f)
            __attribute__((always_inline)) {
              SystemRow& row = system[k];
              store(row.n, link.n);
              f.down.store_unaligned(row.m);
              f.reciprocal().store_unaligned(row.reciprocal);
              link.error.store_unaligned(row.residual);
              zero.store_unaligned(row.lambda);
              zero.store_unaligned(row.p);
              zero.store_unaligned(row.q);
            });
  }
}

/// Computes directions, factors and errors at base + u, and sets lambda = p = q = 0.
void yarn_linearise(const Yarns& y, const YarnBlock& block, float* u, YarnScratch* scratch) {
  with_rows(y, block, u, scratch, [&](auto at) {
    with_base(y, block, [&](auto where) {
      const auto base = rows_of_base(y, block, at, scratch);
      if (y.start != nullptr)
        return linearise_yarns<Along::frozen, where, false>(y, block, at, base);
      with_springs(y, [&](auto springs) {
        linearise_yarns<Along::present, where, springs>(y, block, at, base);
      });
    });
  });
}

template <class At>
[[gnu::always_inline]] inline float read_yarns(const Yarns& y, const YarnBlock& block, At at,
                                               At base) {
  float most = 0;
  alignas(64) float poison[kLanes] = {};
  const std::uint32_t last = rows_of(block) - 1;
  for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
    fetch<Base::fetched>(at, base, lane);
    SystemRow* system = system_of(y, block, lane);
    const Floats zero(0.f);
    Floats worst(0.f), poisoned(0.f);
    FloatVector base_here = base.get(0, lane), here = at.get(0, lane);
    for (std::uint32_t k = 0; k <= last; ++k) {
      SystemRow& row = system[k];
      const std::uint32_t next = std::min(k + 1, last);
      FloatVector base_next = base.get(next, lane), u_next = at.get(next, lane);
      const Floats change = dot(load(row.n), (base_here - base_next) + (here - u_next));
      worst = larger(worst, change);
      poisoned = fused(change, zero, poisoned);
      change.store_unaligned(row.residual);
      zero.store_unaligned(row.lambda);
      zero.store_unaligned(row.p);
      zero.store_unaligned(row.q);
      base_here = base_next;
      here = u_next;
    }
    most = larger(most, worst);
    poisoned.store_unaligned(poison + lane);
  }
  return most + sum(poison);
}

/// Sets residual = J (base + u), where base + u are velocities, and lambda = p = q = 0. Returns the
/// largest residual, or NaN if one is not finite.
float yarn_read(const Yarns& y, const YarnBlock& block, float* u, YarnScratch* scratch) {
  float most = 0;
  with_rows(y, block, u, scratch,
            [&](auto at) { most = read_yarns(y, block, at, rows_of_base(y, block, at, scratch)); });
  return most;
}

/// Computes lambda += alpha p, residual -= alpha q and z = T^-1 residual.
YarnProducts yarn_precondition(const Yarns& y, const YarnBlock& block, float alpha) {
  YarnProducts result;
  alignas(64) float products[kLanes] = {};
  const Floats step(alpha);
  for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
    SystemRow* system = system_of(y, block, lane);
    Floats b(0.f), worst(0.f);
    for (std::uint32_t k = 0; k < rows_of(block); ++k) {
      SystemRow& row = system[k];
      fused(step, load(row.p), load(row.lambda)).store_unaligned(row.lambda);
      const Floats residual = load(row.residual) - step * load(row.q);
      residual.store_unaligned(row.residual);
      const Floats unit =
          y.velocities ? Floats(1.f) : load(kind_of(y, block.first + k).rest + lane);
      worst = larger(worst, residual / xsimd::select(unit > Floats(0.f), unit, Floats(1.f)));
      b = fused(load(row.m), b, residual);
      (b * load(row.reciprocal)).store_unaligned(row.z);
    }
    Floats z(0.f), m(0.f), product(0.f);
    for (std::uint32_t k = rows_of(block); k-- > 0;) {
      SystemRow& row = system[k];
      z = fused(m, z, load(row.z));
      m = load(row.m);
      z.store_unaligned(row.z);
      product = fused(z, load(row.residual), product);
    }
    product.store_unaligned(products + lane);
    result.worst = larger(result.worst, worst);
  }
  result.product = sum(products);
  return result;
}

/// Goes down the yarns with p = z + beta p, and calls push(row of the block, M^-1 J^T p at its
/// particles).
template <class Push>
[[gnu::always_inline]] inline void push_down(const Yarns& y, const YarnBlock& block,
                                             std::uint32_t lane, float beta, Push&& push) {
  const Floats factor(beta);
  SystemRow* system = system_of(y, block, lane);
  FloatVector above = no_vector();
  for (std::uint32_t k = 0; k < rows_of(block); ++k) {
    SystemRow& row = system[k];
    const Floats p = fused(factor, load(row.p), load(row.z));
    p.store_unaligned(row.p);
    FloatVector below = p * load(row.n);
    const Floats w = load(kind_of(y, block.first + k).inverse_mass + lane);
    push(k, w * (below - above));
    above = below;
  }
}

/// Sets t = M^-1 J^T p at the particles of the block. It serves the first family that pushes, and
/// overwrites t. In lanes without yarns t becomes 0, since the scratch is copied back as a whole.
void yarn_push_first(const Yarns& y, const YarnBlock& block, float beta, float* t,
                     YarnScratch* scratch) {
  with_rows(y, block, t, scratch, [&](auto at) {
    for (std::uint32_t lane = 0; lane < kLanes; lane += kFloats) {
      push_down(y, block, lane, beta,
                [&](std::uint32_t k, const FloatVector& own) { at.put(k, lane, own); });
      at.put_back(lane);
    }
  });
}

/// Adds M^-1 J^T p to t.
void yarn_push(const Yarns& y, const YarnBlock& block, float beta, float* t, YarnScratch* scratch) {
  with_rows(y, block, t, scratch, [&](auto at) {
    for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
      at.fetch(lane);
      push_down(y, block, lane, beta, [&](std::uint32_t k, const FloatVector& own) {
        at.put(k, lane, at.get(k, lane) + own);
      });
      at.put_back(lane);
    }
  });
}

template <bool kSprings, class At>
[[gnu::always_inline]] inline Floats pull_yarns(const Yarns& y, const YarnBlock& block, At at,
                                                std::uint32_t lane) {
  SystemRow* system = system_of(y, block, lane);
  FloatVector here = at.get(0, lane);
  Floats product(0.f);
  for (std::uint32_t k = 0; k + 1 < rows_of(block); ++k) {
    SystemRow& row = system[k];
    FloatVector next = at.get(k + 1, lane);
    Floats q = dot(load(row.n), here - next);
    if constexpr (kSprings)
      q = fused(load(y.springs[block.first + k].softness + lane), load(row.p), q);
    q.store_unaligned(row.q);
    product = fused(q, load(row.p), product);
    here = next;
  }
  return product;
}

/// Sets q = J t, of springs + s p, and returns p . q.
float yarn_pull(const Yarns& y, const YarnBlock& block, float* t, YarnScratch* scratch) {
  alignas(64) float products[kLanes] = {};
  with_rows(y, block, t, scratch, [&](auto at) {
    for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
      at.fetch(lane);
      with_springs(y, [&](auto springs) {
        pull_yarns<springs>(y, block, at, lane).store_unaligned(products + lane);
      });
    }
  });
  return sum(products);
}

/// Subtracts M^-1 J^T lambda from t; the sums of springs take their impulses.
void yarn_finish(const Yarns& y, const YarnBlock& block, float* t, YarnScratch* scratch) {
  with_rows(y, block, t, scratch, [&](auto at) {
    for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
      at.fetch(lane);
      const SystemRow* system = system_of(y, block, lane);
      FloatVector above = no_vector();
      for (std::uint32_t k = 0; k < rows_of(block); ++k) {
        const SystemRow& row = system[k];
        FloatVector below = load(row.lambda) * load(row.n);
        const Floats w = load(kind_of(y, block.first + k).inverse_mass + lane);
        at.put(k, lane, fused(w, above - below, at.get(k, lane)));
        if (y.springs != nullptr)
          add_to_sum(y.springs[block.first + k], lane, load(row.lambda), load(row.n));
        above = below;
      }
      at.put_back(lane);
    }
  });
}

template <bool kErrors, bool kKeep, class At>
[[gnu::always_inline]] inline void eliminate_yarns(const Yarns& y, const YarnBlock& block, At at,
                                                   const Scratch& all) {
  const std::uint32_t last = rows_of(block) - 1;
  for (std::uint32_t lane = 0; lane < lanes_of(block); lane += kFloats) {
    ScratchRow* scratch = all.of(lane);
    const SystemRow* system = system_of(y, block, lane);
    at.fetch(lane);
    Floats b(0.f);
    FloatVector here = at.get(0, lane);
    for (std::uint32_t k = 0; k < last; ++k) {
      const SystemRow& row = system[k];
      FloatVector next = at.get(k + 1, lane);
      Floats error = dot(load(row.n), here - next);
      if constexpr (kErrors) error = error + load(row.residual);
      b = fused(load(row.m), b, error);
      at.keep(k, lane, here);
      (load(row.reciprocal) * b).store_unaligned(scratch[k].y);
      here = next;
    }
    at.keep(last, lane, here);
    go_up(
        y, block, lane, scratch,
        [&](std::uint32_t k) __attribute__((always_inline)) {
          return RowFactors{load(system[k].n), load(system[k].m)};
        },
        keep_in_sums<kKeep>(y, block, lane),
        [&](std::uint32_t k, Floats w, const FloatVector& impulse) __attribute__((always_inline)) {
          at.put(k, lane, fused(w, impulse, at.kept(k, lane)));
        });
    at.put_back(lane);
  }
}

/// Subtracts M^-1 J^T T^-1 (J t) from t, or with errors M^-1 J^T T^-1 (residual + J t). As the last
/// it also adds these impulses to the sums of springs.
void yarn_eliminate(const Yarns& y, const YarnBlock& block, float* t, YarnElimination what,
                    YarnScratch* scratch) {
  with_rows(y, block, t, scratch, [&](auto at) {
    const Scratch all(scratch, block);
    if (what == YarnElimination::changes) {
      eliminate_yarns<false, false>(y, block, at, all);
    } else if (what == YarnElimination::last && y.springs != nullptr) {
      eliminate_yarns<true, true>(y, block, at, all);
    } else {
      eliminate_yarns<true, false>(y, block, at, all);
    }
  });
}

/// Adds t to u in the range [first, last) of floats, whose bounds are multiples of kLanes.
void yarn_add(float* u, const float* t, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; i += kFloats) {
    (load(u + i) + load(t + i)).store_unaligned(u + i);
  }
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
