#include "engine/bodies/body_mass.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "engine/bodies/body_shape.h"
#include "engine/bodies/convex_hull.h"
#include "engine/public_vectors.h"
#include "engine/validation.h"

namespace weft {
namespace {

using kernels::Vector;

/// Sums over the parts of a solid of density 1 about the origin: of volume, x and products.
struct Moments {
  double volume = 0;
  Vector first{};
  std::array<double, 6> second{};  // xx, yy, zz, yz, zx, xy

  void add(double part, Vector at) {
    volume += part;
    first = first + part * at;
    const double products[] = {at.x * at.x, at.y * at.y, at.z * at.z,
                               at.y * at.z, at.z * at.x, at.x * at.y};
    for (std::size_t i = 0; i < 6; ++i) second[i] += part * products[i];
  }
};

BodyMass mass_from(const Moments& m, double density) {
  BodyMass mass{.mass = density * m.volume, .centre = to_public((1 / m.volume) * m.first)};
  const Vector c = to_internal(mass.centre);
  const double about[] = {c.x * c.x, c.y * c.y, c.z * c.z, c.y * c.z, c.z * c.x, c.x * c.y};
  std::array<double, 6> s{};
  for (std::size_t i = 0; i < 6; ++i) s[i] = density * (m.second[i] - m.volume * about[i]);
  mass.inertia = {s[1] + s[2], s[2] + s[0], s[0] + s[1], -s[3], -s[4], -s[5]};
  return mass;
}

/// Tetrahedra between the origin and the triangles. Four points of each with equal weights have its
/// second moments.
Moments moments_of_hull(std::span<const Vector> points) {
  static const double kNear = (5 - std::sqrt(5.0)) / 20, kFar = (5 + 3 * std::sqrt(5.0)) / 20;
  const Vector origin = points.front();
  Moments moments;
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

/// The caps end where the cone around the balls touches them.
Moments moments_of_capsule(const reference::Solid& s) {
  const double at_b = s.radius - s.taper * s.length;
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
  Moments moments{.volume = r.volume, .first = r.volume * a + r.first * u};
  const auto product = [&](double ai, double aj, double ui, double uj, double same) {
    return r.volume * ai * aj + r.first * (ai * uj + aj * ui) + r.along * ui * uj +
           r.across * (same - ui * uj);
  };
  moments.second = {product(a.x, a.x, u.x, u.x, 1), product(a.y, a.y, u.y, u.y, 1),
                    product(a.z, a.z, u.z, u.z, 1), product(a.y, a.z, u.y, u.z, 0),
                    product(a.z, a.x, u.z, u.x, 0), product(a.x, a.y, u.x, u.y, 0)};
  return moments;
}

/// All of its principal minors are.
bool is_positive(const SymmetricTensor& m) {
  const auto& [xx, yy, zz, yz, zx, xy] = m.of;
  const double determinant =
      xx * (yy * zz - yz * yz) + xy * (yz * zx - xy * zz) + zx * (xy * yz - yy * zx);
  return xx > 0 && xx * yy - xy * xy > 0 && determinant > 0;
}

}  // namespace

SymmetricTensor inverse(const SymmetricTensor& m) {
  const auto& [xx, yy, zz, yz, zx, xy] = m.of;
  const double a = yy * zz - yz * yz, b = yz * zx - xy * zz, c = xy * yz - yy * zx;
  const double over = 1 / (xx * a + xy * b + zx * c);
  return {{over * a, over * (xx * zz - zx * zx), over * (xx * yy - xy * xy),
           over * (xy * zx - xx * yz), over * c, over * b}};
}

Result<void> validate(const BodyMass& mass) {
  if (auto r = validate_positive("mass.mass", mass.mass); !r) return r;
  if (!finite(mass.centre)) return refuse("mass.centre", "must be finite", text(mass.centre));
  const auto& i = mass.inertia;
  for (std::size_t k = 0; k < 6; ++k) {
    if (!std::isfinite(i[k]))
      return refuse(element("mass.inertia", k), "must be finite", number(i[k]));
  }
  // The sums of m x x and so on, of which the inertia is made, are those of a body.
  const double half = (i[0] + i[1] + i[2]) / 2, slack = 1e-9 * half;
  const SymmetricTensor sums{
      {half - i[0] + slack, half - i[1] + slack, half - i[2] + slack, -i[3], -i[4], -i[5]}};
  if (is_positive({i}) && is_positive(sums)) return {};
  return refuse("mass.inertia", "is that of no body",
                number(i[0]) + ", " + number(i[1]) + ", " + number(i[2]) + ", " + number(i[3]) +
                    ", " + number(i[4]) + ", " + number(i[5]));
}

Result<BodyMass> mass_of(const BodyShape& shape, double density) {
  if (auto r = validate_positive("density", density); !r) return Error{r.error()};
  BodyMass mass;
  if (const auto* hull = std::get_if<Hull>(&shape.description())) {
    std::vector<Vector> points;
    for (const Vec3 p : hull->points) points.push_back(to_internal(p));
    mass = mass_from(moments_of_hull(points), density);
  } else if (shape.mesh() == nullptr && shape.solid().faces.empty()) {
    mass = mass_from(moments_of_capsule(shape.solid()), density);
  } else {
    return refuse("shape", "has a mass as a ball, a capsule or a hull alone",
                  shape.mesh() != nullptr ? "a triangle mesh" : "a plane");
  }
  if (auto r = validate(mass); !r) return Error{r.error()};
  return mass;
}

}  // namespace weft
