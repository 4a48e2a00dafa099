#include "tools/studies/hard/mesh_oracle.h"

#include <algorithm>
#include <cmath>

namespace weft::tools::hard {
namespace {

using Corners = std::array<Vec3, 3>;

double share_of(double part, double whole) {
  return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0;
}

double from_segment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 way = b - a;
  return length(p - (a + share_of(dot(p - a, way), dot(way, way)) * way));
}

/// From its plane where the point is over the triangle, else from its sides.
double from_triangle(Vec3 p, const Corners& t) {
  const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
  bool is_over = dot(normal, normal) > 0;
  double least = from_segment(p, t[0], t[1]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 a = t[k], b = t[(k + 1) % 3];
    is_over = is_over && dot(cross(b - a, p - a), normal) >= 0;
    least = std::min(least, from_segment(p, a, b));
  }
  if (is_over) least = std::min(least, std::abs(dot(normal, p - t[0])) / length(normal));
  return least;
}

/// Where both are nearest within both, or from an end of one to the other.
double between_segments(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  double least = std::min(
      {from_segment(a, c, d), from_segment(b, c, d), from_segment(c, a, b), from_segment(d, a, b)});
  const Vec3 u = b - a, v = d - c, w = c - a, n = cross(u, v);
  const double square = dot(n, n);
  if (!(square > 0)) return least;
  const double s = dot(cross(w, v), n) / square, t = dot(cross(w, u), n) / square;
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1) least = std::min(least, length(w + t * v - s * u));
  return least;
}

double between(const Corners& one, const Corners& other) {
  double least = from_triangle(one[0], other);
  for (std::size_t i = 0; i < 3; ++i) {
    least = std::min({least, from_triangle(one[i], other), from_triangle(other[i], one)});
    for (std::size_t j = 0; j < 3; ++j) {
      least =
          std::min(least, between_segments(one[i], one[(i + 1) % 3], other[j], other[(j + 1) % 3]));
    }
  }
  return least;
}

Corners corners_of(const TriangleSet& set, std::uint32_t triangle) {
  const auto& [a, b, c] = set.triangles[triangle];
  return {set.places[a], set.places[b], set.places[c]};
}

Vec3 placed(const Pose& pose, Vec3 x) {
  const Rotation& r = pose.rotation;
  const Vec3 q{r.x, r.y, r.z}, t = 2.0 * cross(q, x);
  return pose.position + x + r.w * t + cross(q, t);
}

}  // namespace

TriangleSet mesh_at(const TrialBody& body, const Pose& pose, double time) {
  TriangleSet set{{}, body.mesh->triangles};
  for (const Vec3 v : body.vertices ? body.vertices(time) : body.mesh->vertices)
    set.places.push_back(placed(pose, v));
  return set;
}

double distance(const TriangleSet& a, const TriangleSet& b, double reach) {
  double least = reach;
  for (const auto& [i, j] : near_pairs(a, b, reach))
    least = std::min(least, between(corners_of(a, i), corners_of(b, j)));
  return least;
}

}  // namespace weft::tools::hard
