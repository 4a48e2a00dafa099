/// Whether impulses explain a motion. Of all positions that satisfy the constraints those nearest
/// to the prediction x~, masses weighing, are where
///
///     g = M (x - x~) + J^T lambda = 0,     J at x itself
///
/// Each solve acts along the directions before it, so that a turn of theta leaves about sin theta
/// of its motion in g. Where A is nearly singular and the errors are inconsistent (more ropes than
/// a flat net has room for) a solve throws particles far to the side, and those after it converge
/// over there: every constraint is satisfied, and the way there is energy out of nothing.
#pragma once

#include "engine/solvers/direct/direct_system.h"

namespace weft {

class DirectBalance {
 public:
  explicit DirectBalance(const Model& model) : predicted_(model.slots()), g_(model.slots()) {}

  /// From here on impulses are summed.
  void start(kernels::VectorsView x);
  /// Finds g at the positions x that were measured last; the largest |W g| in tolerances.
  double find(const DirectSystem& system, kernels::VectorsView x);
  /// Whether x is the end of a motion that its impulses explain.
  bool is_explained(const DirectSystem& system, kernels::VectorsView x);

  kernels::Vectors& g() { return g_; }
  std::size_t bytes() const { return predicted_.bytes() + g_.bytes(); }

 private:
  kernels::Vectors predicted_, g_;
};

}  // namespace weft
