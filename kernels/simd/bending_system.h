/// The linear system of bending, A x = b, whose matrix is the same for x, y and z.
///
/// All sums run in one order, whatever the instruction set and the number of threads. A sum over
/// particles is added up for ranges, which are the same for any number of threads. In floats a
/// range is short enough that its sum is right to five digits.
#pragma once

#include <type_traits>

#include "kernels/simd/bending_data.h"
#include "kernels/simd/fours.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// q = A p of the groups first ... last - 1. Returns p . q of their slots. Entries of a row are
/// added up in two sums, every other one in the second: products that do not wait for each other.
template <class Real>
double multiply_bending(const BendingMatrix<Real>& a, const Real* p, Real* q, std::size_t first,
                        std::size_t last) {
  using Two = TwoOf<Real>;
  static_assert(kBendingRows == 2);
  const Two none = Two::all(0), inertia = Two::all(a.inertia), stiffness = Two::all(a.stiffness);
  Two product = none;
  for (std::size_t group = first; group < last; ++group) {
    const std::int32_t* column = a.column + a.begin[group];
    const std::int32_t* const end = a.column + a.begin[group + 1];
    const Real* value = a.value + kBendingRows * std::size_t{a.begin[group]};
    Two even = none, odd = none;
    for (; end - column > 1; column += 2, value += 4) {
      even = fused(Two::each(value), Two::load(p + column[0]), even);
      odd = fused(Two::each(value + 2), Two::load(p + column[1]), odd);
    }
    if (column != end) even = fused(Two::each(value), Two::load(p + *column), even);
    const std::size_t slot = kBendingRows * group;
    const Two own = Two::load(p + 4 * slot);
    const Two moved = fused(inertia * Two::each(a.mass + slot), own, stiffness * (even + odd));
    moved.store(q + 4 * slot);
    product = fused(own, moved, product);
  }
  return sum(product);
}

/// r -= inertia M guess and p = r / diagonal, of the slots first ... last - 1.
template <class Real>
BendingNorms begin_gradients(const BendingGradients<Real>& g, const Real* mass, Real inertia,
                             std::size_t first, std::size_t last) {
  using Two = TwoOf<Real>;
  Two left = Two::all(0), force = left;
  for (std::size_t slot = first; slot < last; slot += 2) {
    const std::size_t i = 4 * slot;
    const Two reciprocal = Two::each(g.reciprocal + slot);
    const Two f = Two::all(inertia) * Two::each(mass + slot) * Two::load(g.guess + i);
    const Two r = fused_from(Two::all(1), f, Two::load(g.residual + i));
    const Two p = reciprocal * r;
    r.store(g.residual + i);
    p.store(g.direction + i);
    left = fused(p, r, left);
    force = fused(reciprocal * f, f, force);
  }
  return {sum(left), sum(force)};
}

/// change += alpha p, or = alpha p if it is the first, and r -= alpha A p, of the slots first ...
/// last - 1. Returns r . r / diagonal.
template <class Real>
double step_gradients(const BendingGradients<Real>& g, Real alpha, bool is_first, std::size_t first,
                      std::size_t last) {
  using Two = TwoOf<Real>;
  const Two by = Two::all(alpha);
  Two product = Two::all(0);
  for (std::size_t slot = first; slot < last; slot += 2) {
    const std::size_t i = 4 * slot;
    const Two p = Two::load(g.direction + i);
    (is_first ? by * p : fused(by, p, Two::load(g.change + i))).store(g.change + i);
    const Two r = fused_from(by, Two::load(g.product + i), Two::load(g.residual + i));
    r.store(g.residual + i);
    product = fused(Two::each(g.reciprocal + slot) * r, r, product);
  }
  return sum(product);
}

/// p = r / diagonal + beta p
template <class Real>
void turn_gradients(const BendingGradients<Real>& g, Real beta, std::size_t first,
                    std::size_t last) {
  using Two = TwoOf<Real>;
  const Two by = Two::all(beta);
  for (std::size_t slot = first; slot < last; slot += 2) {
    const std::size_t i = 4 * slot;
    const Two r = Two::load(g.residual + i);
    fused(by, Two::load(g.direction + i), Two::each(g.reciprocal + slot) * r)
        .store(g.direction + i);
  }
}

template <class Real>
constexpr BendingKernels<Real> bending_kernels() {
  return {multiply_bending<Real>, begin_gradients<Real>, step_gradients<Real>,
          turn_gradients<Real>};
}

/// p = z + beta p
void turn_gradients_to(double* p, const double* z, double beta, std::size_t first,
                       std::size_t last) {
  const FourDoubles by = FourDoubles::all(beta);
  for (std::size_t i = 4 * first; i < 4 * last; i += 4)
    fused(by, FourDoubles::load(p + i), FourDoubles::load(z + i)).store(p + i);
}

double dot_vectors(const double* a, const double* b, std::size_t first, std::size_t last) {
  FourDoubles product = FourDoubles::all(0);
  for (std::size_t i = 4 * first; i < 4 * last; i += 4)
    product = fused(FourDoubles::load(a + i), FourDoubles::load(b + i), product);
  return sum(product);
}

/// own = L^-1 own of a front of `columns` columns and `rows` rows below them; from below what own
/// subtracts there.
void solve_vectors_forward(const Front& f, const FrontVectors& v, std::size_t columns,
                           std::size_t rows) {
  for (std::size_t i = 1; i < columns; ++i) {
    FourDoubles x = FourDoubles::load(v.own + 4 * i);
    for (std::size_t k = 0; k < i; ++k)
      x = fused_from(FourDoubles::all(f.panel[k * f.stride + i]), FourDoubles::load(v.own + 4 * k),
                     x);
    x.store(v.own + 4 * i);
  }
  const double* const panel = f.panel + (f.stride - f.below);
  std::size_t i = 0;
  for (; i + 4 <= rows; i += 4) {
    FourDoubles x[4];
    for (std::size_t j = 0; j < 4; ++j) x[j] = FourDoubles::load(v.below + 4 * (i + j));
    for (std::size_t k = 0; k < columns; ++k) {
      const FourDoubles by = FourDoubles::load(v.own + 4 * k);
      const double* const l = panel + k * f.stride + i;
#pragma GCC unroll 4
      for (std::size_t j = 0; j < 4; ++j) x[j] = fused_from(FourDoubles::all(l[j]), by, x[j]);
    }
    for (std::size_t j = 0; j < 4; ++j) x[j].store(v.below + 4 * (i + j));
  }
  for (; i < rows; ++i) {
    FourDoubles x = FourDoubles::load(v.below + 4 * i);
    for (std::size_t k = 0; k < columns; ++k)
      x = fused_from(FourDoubles::all(panel[k * f.stride + i]), FourDoubles::load(v.own + 4 * k),
                     x);
    x.store(v.below + 4 * i);
  }
}

/// own = L^-T (D^-1 own), where below is the solution of the rows below. These are subtracted for
/// four columns at a time: sums that do not wait for each other.
void solve_vectors_backward(const Front& f, const FrontVectors& v, std::size_t columns,
                            std::size_t rows) {
  const std::size_t triangle = f.stride - f.below;
  const auto subtract_below = [&]<std::size_t kColumns>(
                                  std::size_t first,
                                  std::integral_constant<std::size_t, kColumns>) {
    const double* const l = f.panel + first * f.stride + triangle;
    FourDoubles x[kColumns];
    for (std::size_t j = 0; j < kColumns; ++j)
      x[j] = FourDoubles::all(f.reciprocal[first + j]) * FourDoubles::load(v.own + 4 * (first + j));
    for (std::size_t k = 0; k < rows; ++k) {
      const FourDoubles below = FourDoubles::load(v.below + 4 * k);
      for (std::size_t j = 0; j < kColumns; ++j)
        x[j] = fused_from(FourDoubles::all(l[j * f.stride + k]), below, x[j]);
    }
    for (std::size_t j = 0; j < kColumns; ++j) x[j].store(v.own + 4 * (first + j));
  };
  std::size_t i = 0;
  for (; i + 4 <= columns; i += 4) subtract_below(i, std::integral_constant<std::size_t, 4>());
  for (; i < columns; ++i) subtract_below(i, std::integral_constant<std::size_t, 1>());
  for (i = columns; i-- > 0;) {
    const double* const l = f.panel + i * f.stride;
    FourDoubles x = FourDoubles::load(v.own + 4 * i);
    for (std::size_t k = i + 1; k < columns; ++k)
      x = fused_from(FourDoubles::all(l[k]), FourDoubles::load(v.own + 4 * k), x);
    x.store(v.own + 4 * i);
  }
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
