/// Automatic substeps: how many a step is done in.
#pragma once

#include "engine/step/state.h"

namespace weft {

/// As many as the motion and, with yarns, loads want. Predicts all of dt for it: solved, and where
/// heavy spheres might touch contacts, are left as they are there.
int substeps_wanted(State& s, double dt, Team& team);

}  // namespace weft
