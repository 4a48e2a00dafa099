#include "engine/surface/normals.h"

#include <algorithm>
#include <cmath>

namespace weft::surface {

Quad unit(Quad v) {
  const float square = v.x * v.x + v.y * v.y + v.z * v.z;
  return square > 0 ? (1 / std::sqrt(square)) * v : Quad{0, 0, 1, 0};
}

void to_quads(std::span<const Vec3> positions, double scale, std::span<Quad> quads) {
  const Vec3 base = positions[0];
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3 p = positions[i];
    quads[i] = {static_cast<float>(scale * (p.x - base.x)),
                static_cast<float>(scale * (p.y - base.y)),
                static_cast<float>(scale * (p.z - base.z)), 0};
  }
}

double scale_of(std::span<const Vec3> positions) {
  Vec3 least = positions[0], most = positions[0];
  for (const Vec3& p : positions) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
  }
  const double longest = std::max({most.x - least.x, most.y - least.y, most.z - least.z});
  return longest > 0 ? 1 / longest : 1;
}

/// Twice the area of a quad is the product of its diagonals, however it is cut.
void find_areas(const PointFaces& faces, std::span<const Quad> points, std::span<Quad> normals) {
  std::ranges::fill(normals, Quad{});
  for (const auto& [a, b, c] : faces.triangles) {
    const Quad area = cross(points[b] - points[a], points[c] - points[a]);
    for (const std::uint32_t corner : {a, b, c}) normals[corner] = normals[corner] + area;
  }
  for (const auto& [a, b, c, d] : faces.quads) {
    const Quad area = cross(points[c] - points[a], points[d] - points[b]);
    for (const std::uint32_t corner : {a, b, c, d}) normals[corner] = normals[corner] + area;
  }
}

void find_normals(const PointFaces& faces, std::span<const Quad> points, std::span<Quad> normals) {
  find_areas(faces, points, normals);
  for (Quad& normal : normals) normal = unit(normal);
}

}  // namespace weft::surface
