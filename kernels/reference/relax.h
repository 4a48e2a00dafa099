/// The impulse loops of the paper, in double, one constraint after the other: the oracle for every
/// faster kernel. The loop around the methods is
/// kernels/loop.h; the methods are original.h, masked.h (4.3), anticipated.h (4.2), and
/// previewed.h, the original as the paper has it, which `weft paper` measures.
#pragma once

#include "kernels/reference/integrate.h"
#include "kernels/reference/relaxation.h"
#include "kernels/reference/workspace.h"

namespace weft::reference {

struct Method {
  bool anticipate = false;         // 4.2
  bool skip = false;               // 4.3: block flags with anticipation, else 64-bit masks
  bool frozen_directions = false;  // 4.4
  kernels::LoopLimits limits;
};

/// Position loop (3.2, 4.4): moves r.x until every true error is within tolerance.
LoopResult relax_positions(const Relaxation& r, const Topology& topology,
                           const ContactLists& contacts, const Workspace& workspace,
                           const Method& method);

/// The same by the method of previewed.h, whatever `method` says of 4.2 and 4.3. For scheme paper.
LoopResult relax_previewed_positions(const Relaxation& r, const Motion& motion, double h,
                                     const Method& method);

/// Velocity loop (3.2, 3.3): r.x are velocities, r.n the directions at the committed positions,
/// which stay: the problem is linear and one run along fixed directions solves it.
LoopResult relax_velocities(const Relaxation& r, const Topology& topology,
                            const ContactLists& contacts, const Workspace& workspace,
                            const Method& method);

/// Directions of all constraints from the given positions.
void renew_all_directions(const Relaxation& r, VectorsView positions);

}  // namespace weft::reference
