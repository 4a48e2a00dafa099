/// The motion that all others are measured against: the RATTLE scheme in double precision, sparse
/// factors, and nothing of weft's solvers or kernels.
///
/// Known here: distance constraints, fixed particles that stay where they are, gravity. A scene
/// with ropes, springs or spheres is refused.
#pragma once

#include <weft/weft.h>

#include <vector>

namespace weft::tools::precision {

struct Motion {
  std::vector<Vec3> positions;
  std::vector<Vec3> velocities;
};

/// The scene after `steps` steps of h seconds, every strain below 1e-12 after each of them. An
/// error: the scene has what is not known here, or h is too large for the impulses to be found.
Result<Motion> reference_solution(const SceneDescription& scene, double h, int steps);

/// The largest distance (m) between a particle's places in the two.
double trajectory_error(const std::vector<Vec3>& positions, const std::vector<Vec3>& reference);

}  // namespace weft::tools::precision
