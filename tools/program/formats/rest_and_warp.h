/// --rest and --warp: the shape that a mesh has at rest, where it differs from the one it begins
/// in, and where its warp runs in that shape.
#pragma once

#include <string_view>

#include "tools/program/formats/obj_file.h"

namespace weft::tools {

/// given: "FILE.obj", a file of the same vertices and faces at other places, or "uv:SCALE", the
/// texture coordinates times SCALE (m, 1 if it is left out). `scale` is that of --scale: it
/// multiplies the coordinates of FILE.obj too.
Result<void> give_rest(std::string_view given, const ObjFile& file, double scale,
                       MeshDescription& description);

/// given: "x,y,z", the direction of the whole mesh, or "uv", along v of the texture coordinates of
/// each face. The description has its rest shape already.
Result<void> give_warp(std::string_view given, const ObjFile& file, MeshDescription& description);

}  // namespace weft::tools
