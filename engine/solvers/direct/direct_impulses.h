/// One solve: errors become impulses, impulses become motion.
///
/// One-sided constraints. As everywhere in weft it is the sum of a constraint's impulses that is
/// clamped at 0: whoever would pull too much gives back what it had, and leaves the active set once
/// it is slack. The outer loop sees the errors that this leaves.
///   A rope outside the set keeps its row: without direction, it couples with nothing.
///   A contact needs no row. Its particle p may not move along n but as the sphere does: its
///   inverse mass becomes w_p (I - n n^T), the matrix keeps its pattern. Were a contact a row, a
///   free sphere would couple all its contacts with each other, a dense block of hundreds.
#pragma once

#include "engine/solvers/direct/direct_bodies.h"
#include "engine/solvers/direct/direct_factor.h"
#include "engine/solvers/direct/direct_system.h"

namespace weft {

/// lambda and the impulses of touches and ties, from directions and errors. false: not solvable.
bool solve_impulses(DirectSystem& system, DirectFactor& factor, DirectBodies& bodies);

/// u -= M^-1 J^T lambda: every impulse acts on both ends, so momentum is kept.
void apply_impulses(const DirectSystem& system, kernels::VectorsView u);

}  // namespace weft
