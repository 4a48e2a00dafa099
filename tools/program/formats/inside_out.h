/// Which way the triangles of a mesh face.
#pragma once

#include <weft/weft.h>

namespace weft::tools {

/// Whether no two triangles run along an edge in the same direction.
bool is_oriented(const TriangleMesh& mesh);
/// Whether the parts of the surface that are closed enclose a negative volume, all together: their
/// triangles face inwards. A hole in a solid does not make the whole inside out.
bool is_inside_out(const TriangleMesh& mesh);
/// All triangles face the other way.
void turn(TriangleMesh& mesh);

}  // namespace weft::tools
