/// Solver::automatic.
#pragma once

#include <weft/weft.h>

namespace weft {

/// Replaces Solver::automatic by a solver that suits the model, and chooses what goes with it.
void choose_solver(const Model& model, Settings& settings);

}  // namespace weft
