/// Vectors, as meshes need them.
#pragma once

#include <weft/weft.h>

#include <algorithm>
#include <array>

#include "engine/hypotenuse.h"

namespace weft::mesh {

inline double square(double x) { return x * x; }

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(double s, Vec3 v) { return {s * v.x, s * v.y, s * v.z}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3 v) { return hypotenuse(v.x, v.y, v.z); }
/// Along v; nothing else where v is 0.
inline Vec3 unit(Vec3 v) {
  const double size = length(v);
  return size > 0 ? (1 / size) * v : Vec3{};
}

/// Twice the area of the triangle, along its normal.
inline Vec3 area_vector(Vec3 a, Vec3 b, Vec3 c) { return cross(b - a, c - a); }
inline double triangle_area(Vec3 a, Vec3 b, Vec3 c) { return length(area_vector(a, b, c)) / 2; }
/// Heights below this fraction of the longest side are what rounding to single precision makes of
/// three points on a line: such a triangle has no area.
inline constexpr double kFlattest = 1e-6;
inline bool has_area(Vec3 a, Vec3 b, Vec3 c) {
  const double longest = std::max({length(b - a), length(c - b), length(a - c)});
  return length(area_vector(a, b, c)) > kFlattest * longest * longest;
}

/// Symmetric, of three dimensions.
struct Tensor {
  double xx = 0, yy = 0, zz = 0, yz = 0, zx = 0, xy = 0;
};
/// t + s u
inline Tensor plus(Tensor t, double s, const Tensor& u) {
  return {t.xx + s * u.xx, t.yy + s * u.yy, t.zz + s * u.zz,
          t.yz + s * u.yz, t.zx + s * u.zx, t.xy + s * u.xy};
}
/// t + s v v^T
inline Tensor plus_square(Tensor t, double s, Vec3 v) {
  return {t.xx + s * v.x * v.x, t.yy + s * v.y * v.y, t.zz + s * v.z * v.z,
          t.yz + s * v.y * v.z, t.zx + s * v.z * v.x, t.xy + s * v.x * v.y};
}
inline double trace(const Tensor& t) { return t.xx + t.yy + t.zz; }
/// The sum over all nine elements.
inline double sum_of_squares(const Tensor& t) {
  return t.xx * t.xx + t.yy * t.yy + t.zz * t.zz + 2 * (t.yz * t.yz + t.zx * t.zx + t.xy * t.xy);
}
/// The sum over the six, each times its own of the other.
inline double contract(const Tensor& a, const Tensor& b) {
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + a.yz * b.yz + a.zx * b.zx + a.xy * b.xy;
}
/// contract() of it and t is u^T t v.
inline Tensor weights_of_form(Vec3 u, Vec3 v) {
  return {u.x * v.x,
          u.y * v.y,
          u.z * v.z,
          u.y * v.z + u.z * v.y,
          u.z * v.x + u.x * v.z,
          u.x * v.y + u.y * v.x};
}

}  // namespace weft::mesh
