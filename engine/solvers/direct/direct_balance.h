/// Checks whether impulses explain a motion. Among all positions that satisfy the constraints,
/// those nearest to the prediction x~ in the norm weighted by masses satisfy
///
///     g = M (x - x~) + J^T lambda = 0,     J at x itself
///
/// The impulses of a solve act along the directions before it, so that a turn of theta leaves about
/// sin theta of its motion in g. Where A is nearly singular and the errors are inconsistent (more
/// ropes than a flat net has room for), a solve throws particles far to the side, and the following
/// solves converge there: every constraint is satisfied, but the motion has gained energy out of
/// nothing.
#pragma once

#include "engine/solvers/direct/direct_system.h"

namespace weft {

class DirectBalance {
 public:
  explicit DirectBalance(const Model& model) : predicted_(model.slots()), g_(model.slots()) {}

  /// Takes the positions x as the prediction. The system sums impulses from here on.
  void start(kernels::VectorsView x);
  /// Finds g at the positions x, which were measured last. Returns the largest |W g| in units of
  /// the tolerance.
  double find(const DirectSystem& system, kernels::VectorsView x);
  /// Whether the impulses explain the motion from the prediction to x.
  bool is_explained(const DirectSystem& system, kernels::VectorsView x);

  kernels::Vectors& g() { return g_; }
  std::size_t bytes() const { return predicted_.bytes() + g_.bytes(); }

 private:
  kernels::Vectors predicted_, g_;
};

}  // namespace weft
