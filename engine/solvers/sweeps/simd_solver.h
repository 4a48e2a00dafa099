/// Gauss-Seidel on the vector kernels: the same loop as the reference (kernels/loop.h), one pass
/// being
///
///     for each tile (side by side):  for each of its batches:  for each chunk
///     for each batch between tiles:  for each chunk (side by side; of the first, what joins the
///                                    tiles of one thread, at once: sweep_seams)
///     constraints at hubs, one after the other
///     contacts, sphere by sphere
///
/// With Settings::anticipate_products distance constraints keep their errors and pull what their
/// neighbours changed (simd_anticipation.cpp).
///
/// The result depends on neither the number of threads nor, where multiplications and additions are
/// fused, the instruction set.
#pragma once

#include <weft/weft.h>

#include <cstddef>

#include "engine/measure/spring_laws.h"
#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/solvers/sweeps/simd_system.h"
#include "engine/spheres/sphere_contacts.h"
#include "kernels/loop.h"
#include "kernels/simd/table.h"

namespace weft {

class SimdSolver {
 public:
  SimdSolver(const Model& model, const Settings& settings, const simd::Table& table)
      : s_(model, settings, table) {}

  /// Moves x until every constraint and listed contact is within tolerance. first_round: contacts
  /// were found anew, accumulated impulses start at 0. Scheme rattle takes directions at `start`,
  /// if given, instead of x. laws: of a model with springs (PositionTask).
  kernels::LoopResult solve_positions(kernels::VectorsView x, kernels::VectorsView start,
                                      const SphereContacts& contacts, SpringLaws* laws,
                                      bool first_round, const kernels::LoopLimits& limits,
                                      Team& team);
  /// The velocity loop at the positions x.
  kernels::LoopResult correct_velocities(kernels::VectorsView x, kernels::VectorsView v,
                                         const SphereContacts& contacts,
                                         const kernels::LoopLimits& limits, Team& team);
  std::size_t bytes() const { return s_.bytes(); }

 private:
  SimdSystem s_;
};

}  // namespace weft
