/// Anchors in double, one after the other: what the vector kernel (kernels/simd/anchors.h) is held
/// against, and what local passes do.
///
/// An anchor keeps a particle x within a ball around its point p, and out of a sphere behind it,
/// the backstop. With q = p - distance n, the point of that sphere that is nearest to p, its outer
/// normal n there, and its curvature k = 1 / radius, x is outside where
///
///     g = n . w + k/2 |w|^2 >= 0,     w = x - q
///
/// and e = n + k w, of length sqrt(1 + 2 k g), is normal to the sphere around the same centre that
/// x is on. This is exact, and has all digits for a sphere of any size; a plane has k = 0.
///
/// Positions are projected onto the limits that they violate. The part of the velocity that would
/// violate these further is taken, relative to the limit, which moves: a rope that becomes taut, a
/// floor without bounce and without friction. It is taken at the new place. So a particle that
/// stays at its limit moves by BDF2 of the equations of motion with multipliers for position and
/// velocity (Gear, Leimkuhler and Gupta, 1985).
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/vectors.h"

namespace weft::reference {

/// Where an anchor is.
struct AnchorPose {
  kernels::Vector point{}, normal{};
};

/// Where it is in a substep, and how it moves.
struct AnchorMotion {
  kernels::Vector point{}, velocity{};
  kernels::Vector normal{}, turning{};  // 1/s, of the normal

  /// The share of a step between two poses, which is per_second of it.
  static AnchorMotion between(const AnchorPose& from, const AnchorPose& to, double share,
                              double per_second) {
    const kernels::Vector way = to.point - from.point, turn = to.normal - from.normal;
    const kernels::Vector normal = from.normal + share * turn;
    return {from.point + share * way, per_second * way, kernels::direction(normal, length(normal)),
            per_second * turn};
  }
};

/// The limits of an anchor.
struct AnchorLimits {
  double most = 0;       // m; infinite: no limit
  double distance = 0;   // m, of the backstop
  double curvature = 0;  // 1/m
  bool has_backstop = false;
};

/// x as the backstop sees it.
struct BackstopView {
  kernels::Vector w{}, e{};
  double g = 0, size = 0;  // of e

  BackstopView(const AnchorLimits& limits, const AnchorMotion& anchor, kernels::Vector x) {
    w = x - anchor.point + limits.distance * anchor.normal;
    e = anchor.normal + limits.curvature * w;
    g = dot(anchor.normal, w) + 0.5 * limits.curvature * dot(w, w);
    size = std::sqrt(std::max(0.0, 1 + 2 * limits.curvature * g));
  }
  double depth() const { return -2 * g / (1 + size); }
};

struct Held {
  kernels::Vector x{}, v{};
  bool is_at_limit = false;
};

/// Takes the part that leads out of a limit along the unit vector.
inline kernels::Vector without(kernels::Vector v, double outwards, kernels::Vector unit) {
  return v - std::max(0.0, outwards) * unit;
}

/// The point of both the ball's surface and the backstop's that is nearest to x: the circle that
/// they share is at the height z over q along n.
inline kernels::Vector onto_rim(const AnchorLimits& limits, const AnchorMotion& anchor,
                                kernels::Vector x) {
  const double k = limits.curvature, d = limits.distance, most = limits.most;
  const BackstopView view(limits, anchor, x);
  const double z = 0.5 * k * (d * d - most * most) / (1 + k * d);
  const double radius = std::sqrt(std::max(0.0, most * most - (z - d) * (z - d)));
  const kernels::Vector across = view.w - dot(view.w, anchor.normal) * anchor.normal;
  const double l = length(across);
  if (!(l > 0)) return x;
  return anchor.point + (z - d) * anchor.normal + (radius / l) * across;
}

/// The velocity nearest to v of a particle on the rim, x, that leads out of neither limit. With the
/// unit vectors u out of the ball and n out of the backstop it is v - a u + b n, and a and b are
/// where a particle that both hold is held by both, or 0. To take one after the other would leave
/// some of what the second pushes out of the first: what rests would have a speed.
inline kernels::Vector along_rim(const AnchorLimits& limits, const AnchorMotion& anchor,
                                 kernels::Vector x, kernels::Vector v) {
  constexpr double kParallel = 0.01, kCentre = 1e-6;
  const BackstopView view(limits, anchor, x);
  const kernels::Vector u = (1 / limits.most) * (x - anchor.point);
  const kernels::Vector n = view.size > kCentre ? (1 / view.size) * view.e : anchor.normal;
  const kernels::Vector surface = anchor.velocity - limits.distance * anchor.turning;
  const double rising = dot(view.w, anchor.turning) / std::max(view.size, kCentre);
  const double out = dot(u, v - anchor.velocity), in = dot(n, surface - v) - rising;
  const double cosine = dot(u, n);
  const double both = (out + cosine * in) / std::max(1 - cosine * cosine, kParallel);
  const double b = std::max(0.0, in + cosine * std::max(0.0, both));
  const double a = std::max(0.0, out + cosine * b);
  return v - a * u + b * n;
}

inline Held hold(const AnchorLimits& limits, const AnchorMotion& anchor, kernels::Vector x,
                 kernels::Vector v) {
  Held held{x, v};
  const kernels::Vector y = x - anchor.point;
  const double l = length(y), most = limits.most;
  if (l >= most) {
    const kernels::Vector unit = l > 0 ? (1 / l) * y : kernels::Vector{0, 0, 0};
    held.x = anchor.point + most * unit;
    held.v = most > 0 ? without(v, dot(unit, v - anchor.velocity), unit) : anchor.velocity;
    held.is_at_limit = true;
  }
  if (!limits.has_backstop) return held;
  const BackstopView view(limits, anchor, held.x);
  if (!(view.g < 0)) return held;
  constexpr double kCentre = 1e-6;  // so near to the centre the normal is a direction out
  const kernels::Vector unit = view.size > kCentre ? (1 / view.size) * view.e : anchor.normal;
  const kernels::Vector surface = anchor.velocity - limits.distance * anchor.turning;
  const double rising = dot(view.w, anchor.turning) / std::max(view.size, kCentre);
  held.x = held.x + view.depth() * unit;
  held.v = without(held.v, dot(unit, surface - held.v) - rising, -1 * unit);
  held.is_at_limit = true;
  constexpr double kRounding = 1e-6;
  if (length(held.x - anchor.point) > (1 + kRounding) * most) {
    held.x = onto_rim(limits, anchor, held.x);
    if (most > 0) held.v = along_rim(limits, anchor, held.x, v);
  }
  return held;
}

/// m, by which a limit is exceeded; 0: none is.
inline double excess(const AnchorLimits& limits, const AnchorMotion& anchor, kernels::Vector x) {
  const double out = std::max(0.0, length(x - anchor.point) - limits.most);
  if (!limits.has_backstop) return out;
  return std::max(out, BackstopView(limits, anchor, x).depth());
}

}  // namespace weft::reference
