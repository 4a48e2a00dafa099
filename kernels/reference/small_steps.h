/// The formulas of a small step in double, one particle and one block after the other: what the
/// vector kernels (kernels/simd/small_steps.h, small_step_yarns.h) are held against.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "kernels/vectors.h"

namespace weft::reference {

/// A particle in flight: where it is, was a substep ago, and would be without constraints; its
/// velocity, predicted until it is settled, and that of a substep ago.
struct Flight {
  kernels::VectorsView x{}, before{}, predicted{}, v{}, v_before{};
};

/// A substep of b h with the weight c of the past, after one of `last` = b h (0: v is the
/// velocity):
///
///     v  += (x - x*) / last                        settled
///     v*  = v + c (v - v_before) + push a                 push = b h; where motion decays less
///     x*  = x + c (x - x_before) + b h v*
inline void settle(const Flight& f, std::size_t i, double last) {
  if (last > 0) f.v.set(i, f.v[i] + (1 / last) * (f.x[i] - f.predicted[i]));
  f.predicted.set(i, f.x[i]);
}
/// The departure of a substep that is solved but not settled, b h = `last`, with the ratio r to the
/// one before: from its velocity to that which the two before it, u and then v_before, lead to,
///
///     v - v_before - r (v_before - u) = v - v_before - slope (v* - v_before - b h a),
///     slope = r / c
///
/// D being the third derivative of x, BDF2 has the local error (1 + r) / (6 r) h^3 D of x (over b,
/// as the rate at which the global error grows), and the departure is (1 + r) / (2 r) h^2 D: the
/// error is h / 3 of it. With c = 0, slope = 0 it is h times the acceleration, and the error of the
/// implicit Euler method h / 2 of it.
inline kernels::Vector departure(const Flight& f, std::size_t i, kernels::Vector a, double slope,
                                 double last) {
  const kernels::Vector v = f.v[i] + (1 / last) * (f.x[i] - f.predicted[i]);
  return v - f.v_before[i] - slope * (f.v[i] - f.v_before[i] - last * a);
}

inline void advance(const Flight& f, std::size_t i, kernels::Vector a, double c, double bh,
                    double push, double last) {
  settle(f, i, last);
  const kernels::Vector x = f.x[i], v = f.v[i];
  const kernels::Vector v_next = v + c * (v - f.v_before[i]) + push * a;
  const kernels::Vector x_next = x + c * (x - f.before[i]) + bh * v_next;
  f.before.set(i, x);
  f.v_before.set(i, v);
  f.v.set(i, v_next);
  f.predicted.set(i, x_next);
  f.x.set(i, x_next);
}

/// l^2 / L^2 - 1 of the strain l / L - 1.
inline double squared_strain(double strain) { return 2 * strain + strain * strain; }

/// The part of an error that exceeds `most`, in either direction.
inline double beyond(double error, double most) { return error - std::clamp(error, -most, most); }

/// Newton's step for C = (l^2 - L^2) / 2 of one constraint, d its vector, relaxed: the impulse over
/// d, with the mean of l^2 and L^2 for l^2 in the divisor. The part of l^2 / L^2 - 1 within `left`
/// is left.
inline double relaxed_impulse(kernels::Vector d, double rest, double inverse_masses, double omega,
                              double left = 0) {
  const double square = rest * rest, error = dot(d, d) - square;
  return omega * beyond(error, left * square) / ((error + 2 * square) * inverse_masses);
}

/// The law of a constraint in a substep, with the multiplier mu = (b h)^2 f of its tension f:
///
///     C + damping (C - C_start) - softness mu = 0,     C = l - rest,
///     softness = compliance / (b h)^2,   damping = (time constant) / h
///
/// A rope has mu >= 0, and is slack, mu = 0, where the left side is negative. Without a compliance
/// this is C = 0. C_start: when the substep began.
struct ConstraintLaw {
  double softness = 0;
  double damping = 0;
  bool is_rope = false;

  /// The left side; m.
  double residual(double error, double change, double multiplier) const {
    return error + damping * change - softness * multiplier;
  }
  /// The part of it that breaks the law.
  double violation(double residual, double multiplier) const {
    return is_rope ? std::max(residual, -softness * multiplier) : residual;
  }
  /// Newton's step for the multiplier of this constraint alone, relaxed; the relaxation is about
  /// what other constraints move, so a spring of great softness is not relaxed.
  double impulse(double residual, double multiplier, double inverse_masses, double omega) const {
    const double change = residual / ((1 + damping) * inverse_masses / omega + softness);
    return is_rope ? std::max(change, -multiplier) : change;
  }
};

/// The common numbers of the laws of a substep.
struct SpringStep {
  double scale = 0;    // 1 / (b h)^2
  double damping = 0;  // (time constant) / h
  ConstraintLaw law(double compliance, bool is_rope) const {
    return {compliance * scale, compliance > 0 ? damping : 0, is_rope};
  }
};

/// relaxed_impulse() for a chain, of all its constraints together: (A + compliance diag A) lambda =
/// omega C, A = J M^-1 J^T, by elimination. d[k]: from particle k + 1 to particle k; w: one more.
/// Solved in place: error becomes lambda. With springs error is l times the error of the law, and
/// the matrix has also omega l^2 softness on its diagonal.
struct ChainSystem {
  std::vector<kernels::Vector> d;
  std::vector<double> w, error, factor;
  std::vector<double> softness;  // empty: all are rigid
  std::vector<bool> is_left;     // with springs: has no impulse

  void clear() {
    d.clear();
    w.clear();
    error.clear();
    softness.clear();
    is_left.clear();
  }
  void solve(double omega, double compliance) {
    const std::size_t n = d.size();
    factor.assign(n, 0);
    double pivot = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double size = (w[k] + w[k + 1]) * dot(d[k], d[k]);
      const double c = k > 0 ? w[k] * dot(d[k - 1], d[k]) : 0;
      factor[k] = k > 0 && pivot > 0 ? c / pivot : 0;
      error[k] = omega * error[k] + (k > 0 ? factor[k] * error[k - 1] : 0);
      pivot = (1 + compliance) * size - factor[k] * c;
      if (!softness.empty()) pivot += omega * softness[k] * dot(d[k], d[k]);
      if (!is_left.empty() && is_left[k]) pivot = 0;
      pivots_.resize(n);
      pivots_[k] = pivot;
    }
    for (std::size_t k = n; k-- > 0;) {
      error[k] = pivots_[k] > 0 ? error[k] / pivots_[k] : 0;
      if (k + 1 < n) error[k] += factor[k + 1] * error[k + 1];
    }
  }

 private:
  std::vector<double> pivots_;
};

}  // namespace weft::reference
