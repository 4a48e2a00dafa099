/// A mesh as it is drawn: its triangles by vertex, and the data of its normals.
#pragma once

#include <weft/mesh.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace weft::surface {

using Triangle = std::array<std::uint32_t, 3>;

/// Faces whose corners are points: vertices at one place are one point. None is there twice.
struct PointFaces {
  std::vector<Triangle> triangles;
  std::vector<std::array<std::uint32_t, 4>> quads;
  std::size_t bytes() const;
};

struct DrawnVertex {
  std::uint32_t point = kNoIndex;
  float side = 1;  ///< -1: it has the normal of its point turned around
};

struct DrawnMesh {
  std::vector<DrawnVertex> vertices;
  std::vector<Triangle> triangles;  ///< corners are vertices
  PointFaces faces;
  std::vector<std::uint32_t> of_triangles;  ///< per triangle of `faces`: that of `triangles`
  std::vector<std::uint32_t> of_quads;      ///< likewise, the first of two
  std::vector<std::uint32_t> part;          ///< per triangle; empty without parts
  std::size_t bytes() const;
};

/// point_of_vertex: of all corners of faces there is one. parts: the triangles of a cloth that may
/// tear, with points as corners. If there are any, the mesh is drawn by them: four-sided faces are
/// cut as they are, and parts that fit no face come after those that do.
DrawnMesh drawn_mesh(const MeshDescription& mesh, const std::vector<std::uint32_t>& point_of_vertex,
                     std::span<const Triangle> parts = {});
/// The triangles of the mesh with points as corners.
std::vector<Triangle> point_triangles(const DrawnMesh& drawn);

}  // namespace weft::surface
