/// One solve of the direct solver: from errors to impulses, and from impulses to motion.
///
/// As everywhere in weft, the sum of the impulses of a one-sided constraint is clamped at 0: a
/// constraint that would pull too much gives back what it had, and leaves the active set when it is
/// slack. The outer loop sees the errors that this leaves. A rope outside the active set keeps its
/// row in the matrix, with the direction 0, so that it couples with nothing. A contact needs no
/// row. Its particle p may move along n only as the sphere does: its inverse mass becomes w_p (I -
/// n n^T), and the matrix keeps its pattern. If contacts were rows, a free sphere would couple all
/// of its contacts with each other in a dense block of hundreds of rows.
#pragma once

#include "engine/solvers/direct/direct_bodies.h"
#include "engine/solvers/direct/direct_factor.h"
#include "engine/solvers/direct/direct_system.h"

namespace weft {

/// Finds lambda and the impulses of touches and ties from directions and errors. Returns false if
/// the system cannot be solved.
bool solve_impulses(DirectSystem& system, DirectFactor& factor, DirectBodies& bodies);

/// Subtracts M^-1 J^T lambda from u. Every impulse acts on both ends, so that momentum is
/// conserved.
void apply_impulses(const DirectSystem& system, kernels::VectorsView u);

}  // namespace weft
