#include "engine/bodies/body_moments.h"

#include <cmath>
#include <numbers>

#include "engine/bodies/convex_hull.h"

namespace weft {
namespace {

using kernels::Vector;

/// A solid of revolution about z, of discs.
struct Revolution {
  double volume = 0, first = 0, along = 0, across = 0;  // sums of 1, z, z^2 and x^2

  /// square(z): of the radius, a polynomial of the second degree between the two heights.
  template <class Square>
  void add(double low, double high, Square&& square) {
    constexpr double kAt[] = {0, 0.5384693101056831, 0.9061798459386640};
    constexpr double kWeight[] = {128. / 225, 0.4786286704993665, 0.2369268850561891};
    const double half = (high - low) / 2;
    for (int i = -2; i <= 2; ++i) {
      const auto k = static_cast<std::size_t>(std::abs(i));
      const double z = (low + high) / 2 + (i < 0 ? -half : half) * kAt[k];
      const double disc = half * kWeight[k] * std::numbers::pi * square(z);
      volume += disc;
      first += disc * z;
      along += disc * z * z;
      across += disc * square(z) / 4;
    }
  }
};

}  // namespace

/// Tetrahedra between the origin and the triangles. Four points of each with equal weights have its
/// second moments.
BodyMoments moments_of_hull(std::span<const Vector> points) {
  static const double kNear = (5 - std::sqrt(5.0)) / 20, kFar = (5 + 3 * std::sqrt(5.0)) / 20;
  const Vector origin = points.front();
  BodyMoments moments;
  for (const auto& triangle : convex_hull(points)) {
    const Vector corner[] = {origin, points[triangle[0]], points[triangle[1]], points[triangle[2]]};
    const double volume =
        dot(corner[1] - origin, cross(corner[2] - origin, corner[3] - origin)) / 6;
    Vector sum{};
    for (const Vector c : corner) sum = sum + c;
    for (const Vector c : corner) moments.add(volume / 4, kNear * sum + (kFar - kNear) * c);
  }
  return moments;
}

/// The caps end where the cone around the balls touches them.
BodyMoments moments_of_round(const reference::Round& s) {
  const double at_b = s.radius_at_end();
  const double low = s.radius * s.taper, high = s.length + at_b * s.taper;
  const double wide = std::sqrt(1 - s.taper * s.taper);
  Revolution r;
  r.add(-s.radius, low, [&](double z) { return s.radius * s.radius - z * z; });
  r.add(low, high, [&](double z) {
    const double radius = (s.radius - s.taper * z) / wide;
    return radius * radius;
  });
  r.add(high, s.length + at_b,
        [&](double z) { return at_b * at_b - (z - s.length) * (z - s.length); });
  const Vector u = s.length > 0 ? s.axis : Vector{0, 0, 1}, a = s.a;
  BodyMoments moments{.volume = r.volume, .first = r.volume * a + r.first * u};
  const auto product = [&](double ai, double aj, double ui, double uj, double same) {
    return r.volume * ai * aj + r.first * (ai * uj + aj * ui) + r.along * ui * uj +
           r.across * (same - ui * uj);
  };
  moments.second = {product(a.x, a.x, u.x, u.x, 1), product(a.y, a.y, u.y, u.y, 1),
                    product(a.z, a.z, u.z, u.z, 1), product(a.y, a.z, u.y, u.z, 0),
                    product(a.z, a.x, u.z, u.x, 0), product(a.x, a.y, u.x, u.y, 0)};
  return moments;
}

}  // namespace weft
