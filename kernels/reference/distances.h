/// Where two features of two surfaces are nearest to each other, in double: what the vector kernels
/// (kernels/simd/distances.h) are held against. (Ericson, Real-Time Collision Detection, 2005,
/// sections 5.1.5 and 5.1.9.)
///
/// Four points a, b, c, d make up a pair: a point and a triangle b c d, or two edges a b and c d.
/// The vector from the second feature to the first is r, the sum of weight times point.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "kernels/vectors.h"

namespace weft::reference {

using kernels::Vector;

struct Nearest {
  Vector r{};
  std::array<double, 4> weight{};  // of the first feature they sum to 1, of the second to -1
};

/// Which corners of the triangle have a part in the nearest point: bit k, corner k.
inline std::uint32_t corners_of(const Nearest& nearest) {
  std::uint32_t corners = 0;
  for (std::uint32_t k = 0; k < 3; ++k) corners |= (nearest.weight[k + 1] != 0 ? 1u : 0u) << k;
  return corners;
}
/// Whether both nearest points are within their edges, not at an end.
inline bool is_within_edges(const Nearest& nearest) {
  return nearest.weight[0] != 0 && nearest.weight[1] != 0 && nearest.weight[2] != 0 &&
         nearest.weight[3] != 0;
}

/// The share of the way from a to b at which it is nearest to p.
inline double share_of_segment(Vector p, Vector a, Vector b) {
  const Vector u = b - a;
  const double square = dot(u, u);
  return square > 0 ? std::clamp(dot(u, p - a) / square, 0.0, 1.0) : 0;
}

/// The square of the sine between two sides from which on the nearest points within both are taken
/// as they are. Below it rounding may misplace them, and ends are tried, too: the distance is off
/// by 6e-6 of a length at most. It is so from 1e-8 to 0.1; at 1e-10 it is 2e-5, without 0.2.
constexpr double kAcross = 1e-3;

/// On a side, or within all of them, where the triangle has an area.
inline Nearest nearest_in_triangle(Vector p, Vector a, Vector b, Vector c) {
  const Vector u = b - a, v = c - a, w = p - a;
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v);
  const double area = uu * vv - uv * uv, s = vv * wu - uv * wv, t = uu * wv - uv * wu;
  const bool is_within = s > 0 && t > 0 && s + t < area;
  Nearest nearest;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double at_a, double at_b, double at_c) {
    const Vector r = at_a * (p - a) + at_b * (p - b) + at_c * (p - c);
    const double square = dot(r, r);
    if (!(square < least)) return;
    least = square;
    nearest = {r, {1, -at_a, -at_b, -at_c}};
  };
  const auto consider_within = [&] { consider(1 - s / area - t / area, s / area, t / area); };
  if (is_within && area > kAcross * uu * vv) {
    consider_within();
    return nearest;
  }
  const double ab = share_of_segment(p, a, b), bc = share_of_segment(p, b, c),
               ca = share_of_segment(p, c, a);
  consider(1 - ab, ab, 0);
  consider(0, 1 - bc, bc);
  consider(ca, 0, 1 - ca);
  constexpr double kFlat = 1e-14;
  if (is_within && area > kFlat * uu * vv) consider_within();
  return nearest;
}

/// Within both edges, or at an end of one.
inline Nearest nearest_of_edges(Vector a, Vector b, Vector c, Vector d) {
  const Vector u = b - a, v = d - c, w = a - c;
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
  const double determinant = uu * vv - uv * uv, s = uv * vw - uw * vv, t = uu * vw - uv * uw;
  const bool is_within = s > 0 && s < determinant && t > 0 && t < determinant;
  Nearest nearest;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double at_s, double at_t) {
    const Vector r = w + at_s * u - at_t * v;
    const double square = dot(r, r);
    if (!(square < least)) return;
    least = square;
    nearest = {r, {1 - at_s, at_s, at_t - 1, -at_t}};
  };
  if (is_within && determinant > kAcross * uu * vv) {
    consider(s / determinant, t / determinant);
    return nearest;
  }
  consider(0, share_of_segment(a, c, d));
  consider(1, share_of_segment(b, c, d));
  consider(share_of_segment(c, a, b), 0);
  consider(share_of_segment(d, a, b), 1);
  constexpr double kParallel = 1e-14;
  if (is_within && determinant > kParallel * uu * vv) consider(s / determinant, t / determinant);
  return nearest;
}

}  // namespace weft::reference
