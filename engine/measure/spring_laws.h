/// The laws of constraints in models with springs, as solvers of a whole substep see them.
///
/// In a substep of h, with the multiplier mu = h^2 f of the tension f, a spring is to obey
///
///     C + damping (C - C_start) = compliance / h^2 mu,     C = |a-b| - rest_length,
///
/// damping = (time constant) / h, C_start: when the substep began. Divided by 1 + damping this is
/// the law of a spring without damping, of another length and softness:
///
///     |a-b| - target - softness mu = 0,
///     target = rest_length + damping / (1 + damping) C_start,
///     softness = compliance / (h^2 (1 + damping))
///
/// and so is its tolerance divided. A rigid constraint has softness 0, and its own length.
///
/// While a start is projected springs have some time to relax, without damping. Springs that are
/// softer than a given compliance are left as they are, as if they were infinitely soft.
#pragma once

#include <vector>

#include "engine/model/model.h"
#include "kernels/vectors.h"

namespace weft {

struct SpringLaws {
  explicit SpringLaws(const ConstraintStore& constraints);

  /// For a substep of h that begins at `start`, held to `tolerance` times rest_length.
  void begin(const Model& model, kernels::VectorsView start, double h, double tolerance);
  /// For a projection in which springs up to the compliance `softest` have the time h.
  void begin_projection(const Model& model, double softest, double h, double tolerance);
  std::size_t bytes() const;

  kernels::AlignedVector<double> target;      // m
  kernels::AlignedVector<double> softness;    // 1/kg
  kernels::AlignedVector<double> tolerance;   // m
  kernels::AlignedVector<double> multiplier;  // kg m, of springs; solvers write it
};

/// The error of the laws at x, the largest of all constraints, in tolerances; infinite if one is
/// not a number.
double largest_violation(const SpringLaws& laws, const ConstraintStore& constraints,
                         kernels::VectorsView x);
/// J, of springs by their tensions after a substep of h. For a stiff one this is the energy that
/// can come back, without that within the tolerance of its law.
double energy_of_tensions(const SpringLaws& laws, const ConstraintStore& constraints, double h);

}  // namespace weft
