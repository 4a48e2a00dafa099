/// What a mesh may say: checked field by field, before anything is made of it.
#pragma once

#include <weft/mesh.h>

#include <functional>

namespace weft::mesh {

Result<void> check_input(const MeshDescription& mesh);

std::size_t face_count(const MeshDescription& mesh);
/// Calls with the corners of each face.
void for_each_face(const MeshDescription& mesh,
                   const std::function<void(std::span<const std::uint32_t>)>& call);
/// Per vertex: whether it is in a face or a line.
std::vector<bool> used_vertices(const MeshDescription& mesh);

}  // namespace weft::mesh
