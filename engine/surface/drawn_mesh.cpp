#include "engine/surface/drawn_mesh.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "engine/bytes_of.h"
#include "engine/geometry.h"
#include "engine/lists.h"
#include "engine/mesh/mesh_input.h"

namespace weft::surface {
namespace {

using Corners = std::span<const std::uint32_t>;

void add_triangles(const MeshDescription& mesh, Corners face, std::vector<Triangle>& triangles) {
  using mesh::operator-;
  const auto diagonal = [&](std::size_t a, std::size_t b) {
    return mesh::length(mesh.positions[face[b]] - mesh.positions[face[a]]);
  };
  if (face.size() == 4 && diagonal(1, 3) < diagonal(0, 2)) {
    triangles.push_back({face[0], face[1], face[3]});
    triangles.push_back({face[1], face[2], face[3]});
    return;
  }
  for (std::size_t i = 2; i < face.size(); ++i) {
    triangles.push_back({face[0], face[i - 1], face[i]});
  }
}

void add_face(Corners face, PointFaces& faces) {
  if (face.size() == 4) {
    faces.quads.push_back({face[0], face[1], face[2], face[3]});
    return;
  }
  for (std::size_t i = 2; i < face.size(); ++i) {
    faces.triangles.push_back({face[0], face[i - 1], face[i]});
  }
}

/// Per face: the first one with the same corners, in any order; itself, where there is none before.
std::vector<std::uint32_t> first_equals(const Lists& faces) {
  Lists sorted = faces;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    std::sort(sorted.items.begin() + sorted.begin[f], sorted.items.begin() + sorted.begin[f + 1]);
  }
  std::vector<std::uint32_t> order(faces.size()), first(faces.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return std::ranges::lexicographical_compare(sorted[a], sorted[b]);
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeats = i > 0 && std::ranges::equal(sorted[order[i - 1]], sorted[order[i]]);
    first[order[i]] = repeats ? first[order[i - 1]] : order[i];
  }
  return first;
}

/// Whether two faces with the same corners are wound the same way.
bool are_alike(Corners a, Corners b) {
  const auto start = std::ranges::find(b, a[0]);
  const std::size_t after = static_cast<std::size_t>(start - b.begin() + 1) % b.size();
  return b[after] == a[1];
}

/// Vertices that are in `turned` alone have their normals turned around.
void turn(const std::vector<bool>& kept, const std::vector<bool>& turned,
          std::vector<DrawnVertex>& vertices) {
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (turned[v] && !kept[v]) vertices[v].side = -1;
  }
}

}  // namespace

DrawnMesh drawn_mesh(const MeshDescription& mesh,
                     const std::vector<std::uint32_t>& point_of_vertex) {
  DrawnMesh drawn;
  for (const std::uint32_t point : point_of_vertex) drawn.vertices.push_back({point});
  Lists by_vertex, by_point;
  std::vector<std::uint32_t> points;
  mesh::for_each_face(mesh, [&](std::size_t, Corners face) {
    add_triangles(mesh, face, drawn.triangles);
    points.clear();
    for (const std::uint32_t vertex : face) points.push_back(point_of_vertex[vertex]);
    by_vertex.push_back(face);
    by_point.push_back(points);
  });
  const std::vector<std::uint32_t> first = first_equals(by_point);
  std::vector<bool> kept(drawn.vertices.size()), turned(drawn.vertices.size());
  for (std::size_t f = 0; f < first.size(); ++f) {
    if (first[f] == f) add_face(by_point[f], drawn.faces);
    std::vector<bool>& seen = are_alike(by_point[first[f]], by_point[f]) ? kept : turned;
    for (const std::uint32_t vertex : by_vertex[f]) seen[vertex] = true;
  }
  turn(kept, turned, drawn.vertices);
  return drawn;
}

std::vector<Triangle> point_triangles(const DrawnMesh& drawn) {
  std::vector<Triangle> triangles;
  for (const auto& [a, b, c] : drawn.triangles) {
    triangles.push_back(
        {drawn.vertices[a].point, drawn.vertices[b].point, drawn.vertices[c].point});
  }
  return triangles;
}

std::size_t PointFaces::bytes() const { return bytes_of(triangles) + bytes_of(quads); }

std::size_t DrawnMesh::bytes() const {
  return bytes_of(vertices) + bytes_of(triangles) + faces.bytes();
}

}  // namespace weft::surface
