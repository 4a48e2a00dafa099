/// The linear system of all yarns, for conjugate gradients (engine/solvers/yarn_solver.h): A of all
/// families is
///
///     | T_0      C_01 ... |     T_f   tridiagonal: the yarns of family f, solved exactly
///     | C_10     T_1      |     C_fg  where yarns of two families share a particle
///
/// and blockdiag(T_f) is the preconditioner. A p is never formed by entries: the impulses p push
/// the particles by t = M^-1 J^T p (yarn_push, one family after the other), and each constraint
/// reads off how much that changes it, J t (yarn_pull). The first family writes t without reading
/// it, and the last one reads off while it pushes: a sixth of an iteration less.
///
/// With scheme rattle A is that of the directions at the start, J(q) M^-1 J(q)^T, which is
/// symmetric and off by what constraints have turned by since: each Newton step leaves that part of
/// the error (simplified Newton), and the sweep after it, whose tridiagonal matrices are exact,
/// some of it.
///
/// Velocities have the same system, directions and factors of the positions, with J v on the right
/// (yarn_read).
#pragma once

#include <algorithm>

#include "kernels/simd/yarns.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

[[gnu::always_inline]] inline float sum(const float* lanes) {
  float total = 0;
  for (std::uint32_t k = 0; k < kernels::kLanes; ++k) total += lanes[k];
  return total;
}

/// Of absolute values; what is not a number wins.
[[gnu::always_inline]] inline Floats larger(Floats most, Floats v) {
  return xsimd::select(xsimd::abs(v) <= most, most, xsimd::abs(v));
}
[[gnu::always_inline]] inline float larger(float most, Floats v) {
  alignas(64) float lanes[kFloats];
  v.store_aligned(lanes);
  for (const float lane : lanes) most = lane <= most ? most : lane;
  return most;
}

template <Along kAlong, Base kBase>
[[gnu::always_inline]] inline void linearise_yarns(const Yarns& y, const YarnBlock& block,
                                                   Displacements u) {
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    const Floats zero(0.f);
    go_down<kAlong, kBase>(
        y, block, lane, u, unit_link,
        [&](std::uint32_t k, const FloatVector&, const YarnLink& link, const Factors& f) {
          YarnSystemRow& row = y.system[k];
          store(row.n, lane, link.n);
          f.down.store_unaligned(row.m + lane);
          f.reciprocal.store_unaligned(row.reciprocal + lane);
          link.error.store_unaligned(row.residual + lane);
          zero.store_unaligned(row.lambda + lane);
          zero.store_unaligned(row.p + lane);
          zero.store_unaligned(row.q + lane);
        });
  }
}

/// Directions, factors and errors at base + u; lambda = p = q = 0.
void yarn_linearise(const Yarns& y, const YarnBlock& block, Displacements u) {
  with_base(y, [&](auto base) {
    if (y.start == nullptr)
      linearise_yarns<Along::present, base>(y, block, u);
    else
      linearise_yarns<Along::frozen, base>(y, block, u);
  });
}

/// residual = J (base + u), of velocities; lambda = p = q = 0.
void yarn_read(const Yarns& y, const YarnBlock& block, Displacements base, Displacements u) {
  QuadLanes at;
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    const Floats zero(0.f);
    FloatVector base_here = at.get(base, slots(y, block.first, lane));
    FloatVector here = at.get(u, slots(y, block.first, lane));
    for (std::uint32_t k = block.first; k < block.last; ++k) {
      YarnSystemRow& row = y.system[k];
      const std::uint32_t* next = slots(y, std::min(k + 1, block.last - 1), lane);
      const FloatVector base_next = at.get(base, next), u_next = at.get(u, next);
      dot(load(row.n, lane), (base_here - base_next) + (here - u_next))
          .store_unaligned(row.residual + lane);
      zero.store_unaligned(row.lambda + lane);
      zero.store_unaligned(row.p + lane);
      zero.store_unaligned(row.q + lane);
      base_here = base_next;
      here = u_next;
    }
  }
}

/// lambda += alpha p, residual -= alpha q, z = T^-1 residual.
YarnProducts yarn_precondition(const Yarns& y, const YarnBlock& block, float alpha) {
  YarnProducts result;
  alignas(64) float products[kernels::kLanes];
  const Floats step(alpha);
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    Floats b(0.f), worst(0.f);
    for (std::uint32_t k = block.first; k < block.last; ++k) {
      YarnSystemRow& row = y.system[k];
      fused(step, load(row.p + lane), load(row.lambda + lane)).store_unaligned(row.lambda + lane);
      const Floats residual = load(row.residual + lane) - step * load(row.q + lane);
      residual.store_unaligned(row.residual + lane);
      const Floats unit = y.velocities ? Floats(1.f) : load(y.rows[k].rest + lane);
      worst = larger(worst, residual / xsimd::select(unit > Floats(0.f), unit, Floats(1.f)));
      b = fused(load(row.m + lane), b, residual);
      (b * load(row.reciprocal + lane)).store_unaligned(row.z + lane);
    }
    Floats z(0.f), m(0.f), product(0.f);
    for (std::uint32_t k = block.last; k-- > block.first;) {
      YarnSystemRow& row = y.system[k];
      z = fused(m, z, load(row.z + lane));
      m = load(row.m + lane);
      z.store_unaligned(row.z + lane);
      product = fused(z, load(row.residual + lane), product);
    }
    product.store_unaligned(products + lane);
    result.worst = larger(result.worst, worst);
  }
  result.product = sum(products);
  return result;
}

/// Down the yarns with p = z + beta p: push(row, slots, t of the row's particles, p, n) for each.
template <class Push>
[[gnu::always_inline]] inline void push_down(const Yarns& y, const YarnBlock& block,
                                             std::uint32_t lane, float beta, Push&& push) {
  const Floats factor(beta);
  FloatVector above = no_vector();
  for (std::uint32_t k = block.first; k < block.last; ++k) {
    YarnSystemRow& row = y.system[k];
    const Floats p = fused(factor, load(row.p + lane), load(row.z + lane));
    p.store_unaligned(row.p + lane);
    const FloatVector n = load(row.n, lane), below = p * n;
    const Floats w = load(y.rows[k].inverse_mass + lane);
    push(k, slots(y, k, lane), w * (below - above), p, n);
    above = below;
  }
}

/// Of the first family: t = M^-1 J^T p at its particles, whatever it was.
void yarn_push_first(const Yarns& y, const YarnBlock& block, float beta, Displacements t) {
  QuadLanes at;
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    push_down(y, block, lane, beta,
              [&](std::uint32_t, const std::uint32_t* slot, const FloatVector& own, Floats,
                  const FloatVector&) { at.put(t, slot, own); });
  }
}

/// t += M^-1 J^T p.
void yarn_push(const Yarns& y, const YarnBlock& block, float beta, Displacements t) {
  QuadLanes at;
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    push_down(y, block, lane, beta,
              [&](std::uint32_t, const std::uint32_t* slot, const FloatVector& own, Floats,
                  const FloatVector&) { at.put(t, slot, at.get(t, slot) + own); });
  }
}

/// Of the last family, after which t is complete: yarn_push and yarn_pull in one pass.
float yarn_push_pull(const Yarns& y, const YarnBlock& block, float beta, Displacements t) {
  QuadLanes at;
  alignas(64) float products[kernels::kLanes];
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    FloatVector t_above = no_vector(), n_above = no_vector();
    Floats p_above(0.f), product(0.f);
    push_down(y, block, lane, beta,
              [&](std::uint32_t k, const std::uint32_t* slot, const FloatVector& own, Floats p,
                  const FloatVector& n) {
                const FloatVector here = at.get(t, slot) + own;
                at.put(t, slot, here);
                if (k > block.first) {
                  const Floats q = dot(n_above, t_above - here);
                  q.store_unaligned(y.system[k - 1].q + lane);
                  product = fused(q, p_above, product);
                }
                t_above = here;
                n_above = n;
                p_above = p;
              });
    product.store_unaligned(products + lane);
  }
  return sum(products);
}

/// q = J t; returns p . q.
float yarn_pull(const Yarns& y, const YarnBlock& block, Displacements t) {
  QuadLanes at;
  alignas(64) float products[kernels::kLanes];
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    FloatVector here = at.get(t, slots(y, block.first, lane));
    Floats product(0.f);
    for (std::uint32_t k = block.first; k + 1 < block.last; ++k) {
      YarnSystemRow& row = y.system[k];
      const FloatVector next = at.get(t, slots(y, k + 1, lane));
      const Floats q = dot(load(row.n, lane), here - next);
      q.store_unaligned(row.q + lane);
      product = fused(q, load(row.p + lane), product);
      here = next;
    }
    product.store_unaligned(products + lane);
  }
  return sum(products);
}

/// u -= M^-1 J^T lambda.
void yarn_finish(const Yarns& y, const YarnBlock& block, Displacements u) {
  QuadLanes at;
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    FloatVector above = no_vector();
    for (std::uint32_t k = block.first; k < block.last; ++k) {
      const YarnSystemRow& row = y.system[k];
      const FloatVector below = load(row.lambda + lane) * load(row.n, lane);
      const std::uint32_t* slot = slots(y, k, lane);
      const Floats w = load(y.rows[k].inverse_mass + lane);
      at.put(u, slot, fused(w, above - below, at.get(u, slot)));
      above = below;
    }
  }
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
