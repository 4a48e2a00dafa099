/// The stiff attempt of the direct solver.
///
/// Under a heavy end the impulses are so large that a light particle at the least kink is thrown
/// far: the turning of n, which A leaves out, matters most. It is part of the derivative of the
/// balance g (direct_balance.h): that of J^T lambda is the geometric stiffness of the tensions
/// (Tournier et al. 2015), here bounded from above by a block for each particle (Andrews et al.
/// 2017):
///
///     W~ = (M + sum over its constraints of 2 |lambda| / rest (1 - n n^T))^-1
///     (J W~ J^T) d = e - J W~ g,     x -= W~ (g + J^T d),     lambda += d
///
/// It converges slowly but surely: a chain of 20 under 10^6 times its particles' mass needs it, on
/// sheets of equal masses sweeps are faster. So it comes before them, but only where masses differ
/// by a factor of 100 and more, and in scenes of rows alone. At the end what is left of g is
/// applied, so that momentum is kept to rounding.
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

  /// Whether masses are such that the attempt may be needed.
  bool wanted() const { return !soft_.empty(); }
  /// From x, where the balance starts.
  DirectOutcome iterate(DirectSystem& system, DirectFactor& factor, DirectBalance& balance,
                        kernels::VectorsView x, const ContactStore& contacts, int max_iterations,
                        kernels::LoopResult& result);
  std::size_t bytes() const;

 private:
  void stiffen(const DirectSystem& system);
  void solve(DirectSystem& system, DirectFactor& factor, kernels::Vectors& g,
             kernels::VectorsView x);

  std::vector<Symmetric> soft_;  // W~, per slot
};

}  // namespace weft
