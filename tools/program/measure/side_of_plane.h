/// On which side of a plane a point is, without rounding.
#pragma once

#include <weft/weft.h>

namespace weft::tools {

/// The sign of the volume of the tetrahedron a b c d: -1, 0 or 1, as exact arithmetic has it. 0:
/// the four points are in one plane.
int side_of_plane(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

}  // namespace weft::tools
