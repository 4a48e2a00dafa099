/// What kind of file a path names.
#pragma once

#include <string>

namespace weft::tools {

/// ".obj" of "mesh.obj" and of "MESH.OBJ": in small letters, since some systems write large ones.
std::string file_ending(const std::string& path);

}  // namespace weft::tools
