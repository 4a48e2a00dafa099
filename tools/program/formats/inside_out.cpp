#include "tools/program/formats/inside_out.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace weft::tools {
namespace {

using Side = std::pair<std::uint32_t, std::uint32_t>;

/// In order.
std::vector<Side> sides_of(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  for (const auto& [a, b, c] : mesh.triangles) sides.insert(sides.end(), {{a, b}, {b, c}, {c, a}});
  std::ranges::sort(sides);
  return sides;
}

/// Per vertex: the first of its part, which triangles join.
std::vector<std::uint32_t> parts_of(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> first(mesh.vertices.size());
  std::iota(first.begin(), first.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (first[v] != v) v = first[v] = first[first[v]];
    return v;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t least = std::min({root(a), root(b), root(c)});
    for (const std::uint32_t v : {a, b, c}) first[root(v)] = least;
  }
  for (std::uint32_t v = 0; v < first.size(); ++v) first[v] = root(v);
  return first;
}

}  // namespace

bool is_oriented(const TriangleMesh& mesh) {
  const std::vector<Side> sides = sides_of(mesh);
  return std::ranges::adjacent_find(sides) == sides.end();
}

/// Seen from one of its vertices: far from the origin rounding would be all of the volume.
bool is_inside_out(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return false;
  const std::vector<Side> sides = sides_of(mesh);
  const std::vector<std::uint32_t> part = parts_of(mesh);
  std::vector<bool> is_open(mesh.vertices.size());
  for (const auto& [a, b] : sides) {
    if (!std::ranges::binary_search(sides, Side{b, a})) is_open[part[a]] = true;
  }
  double volume = 0;
  const Vec3 base = mesh.vertices[mesh.triangles[0][0]];
  const auto at = [&](std::uint32_t v) {
    const Vec3 p = mesh.vertices[v];
    return Vec3{p.x - base.x, p.y - base.y, p.z - base.z};
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    if (is_open[part[a]]) continue;
    const Vec3 p = at(a), q = at(b), r = at(c);
    volume += p.x * (q.y * r.z - q.z * r.y) + p.y * (q.z * r.x - q.x * r.z) +
              p.z * (q.x * r.y - q.y * r.x);
  }
  return volume < 0;
}

void turn(TriangleMesh& mesh) {
  for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
}

}  // namespace weft::tools
