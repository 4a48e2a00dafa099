/// Which vertices of a mesh are fixed: the rules of --pin, see ObjOptions::pin.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <string_view>
#include <vector>

#include "tools/scenes/mesh.h"

namespace weft::tools {

/// The numbers of the fixed vertices, ascending; of those alone that are in a face or a line. A
/// rule that cannot be read or that matches no vertex (other than "none") is an error. up: the
/// coordinate that "top" is about.
Result<std::vector<std::uint32_t>> pinned_vertices(std::string_view rule, const Mesh& mesh,
                                                   double Vec3::*up = &Vec3::y);

}  // namespace weft::tools
