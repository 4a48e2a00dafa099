/// How near cloth is to bodies that are triangle meshes: by distances of its own.
#pragma once

#include "tools/program/measure/crossings.h"
#include "tools/studies/hard/body_oracle.h"

namespace weft::tools::hard {

/// The mesh of a body where it is.
TriangleSet mesh_at(const TrialBody& body, const Pose& pose, double time);

/// m, between two surfaces, or `reach` where no two triangles are as near as that. Of triangles
/// that cross the distance is that of their edges and corners.
double distance(const TriangleSet& a, const TriangleSet& b, double reach);

}  // namespace weft::tools::hard
