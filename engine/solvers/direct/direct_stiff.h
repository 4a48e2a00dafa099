/// A second Newton method of the direct solver, which includes the geometric stiffness.
///
/// Where a chain ends in a heavy particle, the impulses are so large that the smallest kink throws
/// a light particle far: the turning of n, which A leaves out, dominates. It is part of the
/// derivative of the balance g (direct_balance.h). The derivative of J^T lambda is the geometric
/// stiffness of the tensions (Tournier et al. 2015), which is bounded from above here by one block
/// for each particle (Andrews et al. 2017):
///
///     W~ = (M + sum over its constraints of 2 |lambda| / rest (1 - n n^T))^-1
///     (J W~ J^T) d = e - J W~ g,     x -= W~ (g + J^T d),     lambda += d
///
/// The method converges slowly but reliably. It is used only where masses differ by a factor of 100
/// or more, since sweeps are faster on sheets of equal masses, and only in scenes without bodies
/// and contacts. At the end what is left of g is applied, so that momentum is conserved up to
/// rounding.
#pragma once

#include "engine/solvers/direct/direct_balance.h"
#include "engine/solvers/direct/direct_factor.h"
#include "engine/solvers/direct/direct_system.h"
#include "kernels/loop.h"

namespace weft {

/// A symmetric 3 x 3 matrix.
struct Symmetric {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

class DirectStiff {
 public:
  explicit DirectStiff(const Model& model);

  /// Whether the model is one for which the method is used.
  bool wanted() const { return !soft_.empty(); }
  /// Iterates from x, which is also the prediction of the balance.
  DirectOutcome iterate(DirectSystem& system, DirectFactor& factor, DirectBalance& balance,
                        kernels::VectorsView x, const SphereContacts& contacts, int max_iterations,
                        kernels::LoopResult& result);
  std::size_t bytes() const;

 private:
  void stiffen(const DirectSystem& system);
  void solve(DirectSystem& system, DirectFactor& factor, kernels::Vectors& g,
             kernels::VectorsView x);

  std::vector<Symmetric> soft_;  // W~, per slot
};

}  // namespace weft
