/// Triangles of fabric (weft.h) in double, one after the other: what the vector kernels
/// (kernels/simd/membrane.h) are held against, and what local passes and measurements use.
///
/// The deformation F = [f_u f_v] is linear in the corners: f_u = sum of u_k x_k, f_v = sum of v_k
/// x_k, with weights that sum to zero. An impulse p along the gradient (g_u, g_v) of a law by (f_u,
/// f_v) moves corner k, of the inverse mass w_k, by
///
///     x_k -= p w_k (u_k g_u + v_k g_v)
///
/// and so the deformation by
///
///     f_u -= p (W_uu g_u + W_uv g_v),   f_v -= p (W_uv g_u + W_vv g_v),   W_uv = sum of w_k u_k
///     v_k
///
/// A visit needs nothing of the corners but this.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "kernels/reference/small_steps.h"
#include "kernels/vectors.h"

namespace weft::reference {

/// Along the warp and along the weft.
struct MembraneShape {
  std::array<double, 3> u{}, v{};  // 1/m, weights of the corners; each sums to 0
  double area = 0;                 // m^2, at rest
};

/// rest: the corners in the plane of the fabric, which must not lie on a line.
inline MembraneShape shape_of(const std::array<std::array<double, 2>, 3>& rest) {
  const double u1 = rest[1][0] - rest[0][0], v1 = rest[1][1] - rest[0][1];
  const double u2 = rest[2][0] - rest[0][0], v2 = rest[2][1] - rest[0][1];
  const double twice = u1 * v2 - u2 * v1;
  MembraneShape shape{{0, v2 / twice, -v1 / twice}, {0, -u2 / twice, u1 / twice}};
  shape.u[0] = -shape.u[1] - shape.u[2];
  shape.v[0] = -shape.v[1] - shape.v[2];
  shape.area = 0.5 * std::abs(twice);
  return shape;
}

struct Deformation {
  kernels::Vector u{}, v{};
};

/// The corners 1 and 2 lie at d1 and d2 from corner 0.
inline Deformation deformation(const MembraneShape& s, kernels::Vector d1, kernels::Vector d2) {
  return {s.u[1] * d1 + s.u[2] * d2, s.v[1] * d1 + s.v[2] * d2};
}

/// W, 1/(kg m^2)
struct MembraneMobility {
  double uu = 0, uv = 0, vv = 0;
  double most() const { return std::max(uu, vv); }
};

inline MembraneMobility mobility(const MembraneShape& s, const std::array<double, 3>& w) {
  MembraneMobility sum;
  for (std::size_t k = 0; k < 3; ++k) {
    sum.uu += w[k] * s.u[k] * s.u[k];
    sum.uv += w[k] * s.u[k] * s.v[k];
    sum.vv += w[k] * s.v[k] * s.v[k];
  }
  return sum;
}

inline constexpr std::size_t kMembraneLaws = 3;  // warp, weft, shear

struct MembraneElement {
  MembraneShape shape;
  MembraneMobility mobility;
  std::array<double, kMembraneLaws> stiffness{};  // N/m
  bool is_rope = false;
};

/// The left side of a law, its gradient by the deformation, and the inverse mass that an impulse
/// along that meets.
struct MembraneTerm {
  double error = 0;
  Deformation gradient{};
  double inverse_mass = 0;  // 1/(kg m^2)
};

/// Lengths and areas whose squares are less have no direction.
inline constexpr double kLeastDeformation = 1e-30, kLeastDeformedArea = 1e-12;
/// The smallest inverse mass of shear, over that of warp and weft together.
inline constexpr double kLeastShearMobility = 0x1p-20;

inline MembraneTerm stretch_term(kernels::Vector f, double mobility, bool along_u) {
  const double length = std::sqrt(dot(f, f) + kLeastDeformation);
  const kernels::Vector n = (1 / length) * f;
  const kernels::Vector none{0, 0, 0};
  return {length - 1, along_u ? Deformation{n, none} : Deformation{none, n}, mobility};
}

/// C = cos(angle) has the gradient sin(angle), and Newton's method would leap from small angles.
/// The square of that is left out of the inverse mass: near the right angle this is the same, and a
/// visit never turns by more than it should.
inline MembraneTerm shear_term(const Deformation& f, const MembraneMobility& m) {
  const double uu = dot(f.u, f.u), vv = dot(f.v, f.v);
  const double over = 1 / std::sqrt(std::max(uu * vv, kLeastDeformedArea));
  const double c = over * dot(f.u, f.v);
  const double u = vv * over * over, v = uu * over * over;  // 1 / uu, 1 / vv
  const double size = m.uu * u + m.vv * v;
  return {c,
          {over * f.v - (c * u) * f.u, over * f.u - (c * v) * f.v},
          std::max(size - 2 * c * over * m.uv, kLeastShearMobility * size)};
}

inline MembraneTerm term(const MembraneElement& e, const Deformation& f, std::size_t law) {
  if (law == 0) return stretch_term(f.u, e.mobility.uu, true);
  if (law == 1) return stretch_term(f.v, e.mobility.vv, false);
  return shear_term(f, e.mobility);
}

/// A law in a substep, with the multiplier mu = (b h)^2 A T of its force T per width:
///
///     k A (b h)^2 (C + damping (C - C_start)) = mu,   damping = (time constant) / h
///
/// That of a rope has mu >= 0, and is slack, mu = 0, where the left side is negative. C_start: when
/// the substep began.
struct MembraneLaw {
  double stiffness = 0;  // k A (b h)^2; 0: there is no law, and mu is 0
  double damping = 0;
  bool is_rope = false;

  /// The lack of the multiplier.
  double lack(double error, double change, double multiplier) const {
    return stiffness * (error + damping * change) - multiplier;
  }
  /// The error of the law, a strain.
  double violation(double lack, double multiplier) const {
    if (stiffness == 0) return 0;
    return (is_rope ? std::max(lack, -multiplier) : lack) / stiffness;
  }
  /// A step for the multiplier, such that the law holds at the end of the sweep in a cloth at rest.
  /// There a sweep brings an element back to where it was: visits of its neighbours undo what its
  /// own visit moved it, half of that on average before the sweep ends. So the law is to hold where
  /// the element is then, at half of its own way. (Newton's step would make it hold right after the
  /// visit, and the cloth too soft by that half.) A law too stiff for that is relaxed as that of a
  /// rigid spring is (reference::ConstraintLaw).
  double impulse(double lack, double multiplier, double inverse_mass, double omega) const {
    const double own = stiffness * (1 + damping) * inverse_mass;
    const double change = lack / std::max(own / omega, 0.5 * own + 1);
    return is_rope ? std::max(change, -multiplier) : change;
  }
};

/// The common numbers of the laws of a substep.
struct MembraneStep {
  double give = 0;     // (b h)^2
  double damping = 0;  // (time constant) / h

  MembraneLaw law(const MembraneElement& e, std::size_t k) const {
    return {e.stiffness[k] * e.shape.area * give, damping, e.is_rope && k < 2};
  }
};

using MembraneMultipliers = std::array<double, kMembraneLaws>;

/// How far from its laws an element is: the largest of what is left of them.
inline double violation(const MembraneElement& e, const MembraneStep& step, const Deformation& f,
                        const Deformation& start, const MembraneMultipliers& multipliers) {
  double most = 0;
  for (std::size_t k = 0; k < kMembraneLaws; ++k) {
    const MembraneLaw law = step.law(e, k);
    const double error = term(e, f, k).error;
    const double change = step.damping > 0 ? error - term(e, start, k).error : 0;
    const double left = law.lack(error, change, multipliers[k]);
    most = std::max(most, std::abs(law.violation(left, multipliers[k])));
  }
  return most;
}

/// Visits the laws one after the other. The multipliers of a substep begin at zero. Corner k moves
/// by -w_k (u_k push.u + v_k push.v), push being what this returns. The error of a law up to the
/// strain `left` is left.
inline Deformation relax(const MembraneElement& e, const MembraneStep& step, double omega,
                         Deformation f, const Deformation& start, MembraneMultipliers& multipliers,
                         double left = 0) {
  Deformation push{};
  for (std::size_t k = 0; k < kMembraneLaws; ++k) {
    const MembraneLaw law = step.law(e, k);
    const MembraneTerm at = term(e, f, k);
    const double change = step.damping > 0 ? at.error - term(e, start, k).error : 0;
    const double lack = beyond(law.lack(at.error, change, multipliers[k]), left * law.stiffness);
    const double p = law.impulse(lack, multipliers[k], at.inverse_mass, omega);
    multipliers[k] += p;
    const Deformation& g = at.gradient;
    const MembraneMobility& m = e.mobility;
    push = {push.u + p * g.u, push.v + p * g.v};
    f = {f.u - (p * m.uu) * g.u - (p * m.uv) * g.v, f.v - (p * m.uv) * g.u - (p * m.vv) * g.v};
  }
  return push;
}

/// J. A law that is stiffer than a sweep resolves has the energy of one that is not: give_per_mass
/// is (b h)^2 over the relaxation (engine/measure/state_measure.h).
inline double energy(const MembraneElement& e, const Deformation& f, double give_per_mass) {
  double sum = 0;
  for (std::size_t k = 0; k < kMembraneLaws; ++k) {
    const MembraneTerm at = term(e, f, k);
    if (e.is_rope && k < 2 && at.error < 0) continue;
    const double stiffness = e.stiffness[k] * e.shape.area;
    sum +=
        0.5 * stiffness * at.error * at.error / (1 + stiffness * give_per_mass * at.inverse_mass);
  }
  return sum;
}

}  // namespace weft::reference
