/// What an OBJ file has, before anything is made of it.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "tools/scenes/mesh.h"

namespace weft::tools {

/// The u and the v of texture coordinates.
using FlatPlace = std::array<double, 2>;

struct ObjFile {
  Mesh mesh;  ///< of all objects and groups; without particles
  /// One per corner of the faces, face after face; nothing where a corner has no vt of two numbers.
  std::vector<std::optional<FlatPlace>> texture;
};

/// The texture of all corners. The error names the first face that lacks some.
Result<std::vector<FlatPlace>> whole_texture(const ObjFile& file);

/// An error names the line.
Result<ObjFile> parse_obj_file(std::string_view text);

}  // namespace weft::tools
