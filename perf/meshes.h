/// What the benchmarks run on. Deterministic, SI units, without fixed particles unless said.
#pragma once

#include <weft/weft.h>

#include "tools/scenes/splitmix.h"

namespace weft::perf {

using Random = scenes::SplitMix;

/// N x N particles in the plane, structural edges, every particle moved by up to 2 % of an edge.
SceneDescription grid(int size);

/// The mesh of tools/scenes/irregular_mesh.h, N x N particles. The first row of particles is fixed;
/// rest lengths are the distances.
SceneDescription irregular(int size);

}  // namespace weft::perf
