/// The laws of constraints in models with springs (reference::ConstraintLaw), one after the other.
///
/// points: difference(a, b), the vector from slot b to slot a; start_difference(a, b), the same
/// when the substep began; move(slot, by); multiplier(constraint) and set_multiplier(constraint,
/// to).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/model/model.h"
#include "kernels/reference/small_steps.h"

namespace weft {

/// The common numbers of all laws in a substep.
struct LawStep {
  reference::SpringStep springs{};
  double softest = std::numeric_limits<double>::infinity();  // m/N; softer springs are left
  double damping_of_triangles = 0;  // (time constant) / h, of what a sweep can damp of it

  bool is_kept(const ConstraintStore& s, std::uint32_t c) const {
    return s.compliance[c] <= softest;
  }
  /// Triangles of fabric take part where any springs do.
  bool leaves_triangles() const { return softest == 0; }
};

/// A constraint as its law sees it.
struct LawVisit {
  reference::ConstraintLaw law;
  kernels::Vector d{};  // from b to a
  double length = 0, residual = 0, multiplier = 0;
  double violation() const { return law.violation(residual, multiplier); }
};

template <class Points>
LawVisit visit_law(const ConstraintStore& s, const Points& points,
                   const reference::SpringStep& step, std::uint32_t c) {
  LawVisit visit{.law = step.law(s.compliance[c], c >= s.bilateral),
                 .d = points.difference(s.a[c], s.b[c])};
  visit.length = kernels::length(visit.d);
  visit.multiplier = points.multiplier(c);
  const bool is_damped = visit.law.damping > 0;
  const double change =
      is_damped ? visit.length - kernels::length(points.start_difference(s.a[c], s.b[c])) : 0;
  visit.residual = visit.law.residual(visit.length - s.rest_length[c], change, visit.multiplier);
  return visit;
}

/// By how much a constraint breaks its law, over rest_length.
template <class Points>
double violation_of_law(const ConstraintStore& s, const Points& points, const LawStep& step,
                        std::uint32_t c) {
  if (!step.is_kept(s, c)) return 0;
  return std::abs(visit_law(s, points, step.springs, c).violation()) / s.rest_length[c];
}

/// The largest violation of all laws.
template <class Points>
double largest_violation(const ConstraintStore& s, const Points& points, const LawStep& step) {
  double most = 0;
  for (std::uint32_t c = 0; c < s.size(); ++c)
    most = std::max(most, violation_of_law(s, points, step, c));
  return most;
}

/// Applies the impulse that this constraint alone asks for, relaxed.
template <class Points>
void apply_law(const Model& model, Points& points, const LawVisit& visit, double omega,
               std::uint32_t c) {
  const ConstraintStore& s = model.constraints;
  const double impulse =
      visit.law.impulse(visit.residual, visit.multiplier, 1 / s.effective_mass[c], omega);
  const kernels::Vector by = impulse * kernels::direction(visit.d, visit.length);
  points.set_multiplier(c, visit.multiplier + impulse);
  points.move(s.a[c], -model.inverse_mass[s.a[c]] * by);
  points.move(s.b[c], model.inverse_mass[s.b[c]] * by);
}

/// The visit of a sweep, the first of the substep or another. The multiplier of a substep begins at
/// zero.
template <class Points>
void sweep_law(const Model& model, Points& points, const LawStep& step, bool is_first, double omega,
               std::uint32_t c) {
  const ConstraintStore& s = model.constraints;
  if (is_first) points.set_multiplier(c, 0);
  if (step.is_kept(s, c)) apply_law(model, points, visit_law(s, points, step.springs, c), omega, c);
}

}  // namespace weft
