/// Solver::automatic and Scheme::automatic.
#pragma once

#include <weft/weft.h>

namespace weft {

/// Replaces Solver::automatic by a solver that suits the model, and chooses what goes with it.
void choose_solver(const Model& model, Settings& settings);

/// The scheme of settings whose solver is chosen.
Scheme scheme_of(const Settings& settings);
bool is_of_small_steps(Scheme scheme);

}  // namespace weft
