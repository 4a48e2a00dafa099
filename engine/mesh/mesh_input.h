/// Checks of a mesh, field by field, before anything is made of it.
#pragma once

#include <weft/mesh.h>

#include <functional>

namespace weft::mesh {

Result<void> check_input(const MeshDescription& mesh);

std::size_t face_count(const MeshDescription& mesh);
/// Calls with the number of each face's first corner, and the vertices of its corners.
void for_each_face(
    const MeshDescription& mesh,
    const std::function<void(std::size_t first, std::span<const std::uint32_t> vertices)>& call);
/// Whether any triangle from the first corner of the face has an area.
bool has_area(std::span<const Vec3> face);
/// Where a corner of a face lies at rest; a flat place (u, v) is (u, v, 0).
Vec3 rest_of_corner(const MeshDescription& mesh, std::size_t corner);
/// Where a vertex of a line lies at rest.
Vec3 rest_of_vertex(const MeshDescription& mesh, std::uint32_t vertex);
/// Per vertex: whether it is in a face or a line.
std::vector<bool> used_vertices(const MeshDescription& mesh);

}  // namespace weft::mesh
