/// The triangles and quads of a mesh, each in its own shape at rest.
#pragma once

#include <weft/mesh.h>

#include <vector>

#include "engine/geometry.h"

namespace weft::mesh {

/// In order around it. Neighbours that are sewn together may lie apart, so each face has places of
/// its own for the particles that they share.
struct Face {
  std::size_t size = 0;  ///< 3 or 4
  std::array<std::uint32_t, 4> particles{};
  std::array<Vec3, 4> places{};
  Vec3 warp;                   ///< as given_warp (warp.h)
  bool is_recognised = false;  ///< it was two triangles (grid_recognition.h)

  std::size_t next(std::size_t i) const { return i + 1 < size ? i + 1 : 0; }
  std::size_t previous(std::size_t i) const { return i > 0 ? i - 1 : size - 1; }
  bool is_quad() const { return size == 4; }
};

/// From a corner to the next.
inline Vec3 side_vector(const Face& face, std::size_t side) {
  return face.places[face.next(side)] - face.places[side];
}
inline double side_length(const Face& face, std::size_t side) {
  return length(side_vector(face, side));
}
/// Twice the area, along the normal.
Vec3 area_vector(const Face& face);
double area(const Face& face);
/// By triangles, of quads the mean of both ways to cut them: what is the corner's of the area.
std::array<double, 4> corner_areas(const Face& face);
/// The three corners, in their order.
Face triangle_of(const Face& face, std::array<std::size_t, 3> corners);
/// Corners of the two triangles that the shorter diagonal cuts a quad into. The diagonal runs from
/// the first to the last corner of each.
std::array<std::array<std::size_t, 3>, 2> cut(const Face& quad);

/// The greatest distance from the first corner of all, m.
double extent(const std::vector<Face>& faces);

struct Faces {
  std::vector<Face> faces;  ///< convex, with area, none twice
  std::size_t degenerate = 0;
  std::size_t doubles = 0;  ///< with the particles of an earlier face at the same places
};
Faces faces_of(const MeshDescription& mesh, const std::vector<std::uint32_t>& particle_of_vertex);

}  // namespace weft::mesh
