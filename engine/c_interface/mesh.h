/// Meshes of C.
#pragma once

#include <weft/mesh.h>
#include <weft/weft_c.h>

#include <string_view>

namespace weft::c_interface {

Result<MeshDescription> read_mesh(std::string_view name, const weft_mesh* mesh);

}  // namespace weft::c_interface
