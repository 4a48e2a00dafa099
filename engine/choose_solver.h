/// Solver::automatic.
#pragma once

#include <weft/weft.h>

namespace weft {

/// Replaces Solver::automatic by a solver, and chooses what goes with it.
void choose_solver(Settings& settings);

}  // namespace weft
