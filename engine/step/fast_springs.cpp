#include "engine/step/fast_springs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/measure/state_measure.h"
#include "engine/model/change.h"
#include "engine/tuning.h"

namespace weft {
namespace {

constexpr double kSquareOfTime = tuning::kLongestSubstep * tuning::kLongestSubstep;

bool is_fast(const ConstraintStore& s, std::uint32_t c) {
  return s.compliance[c] > 0 && s.compliance[c] * s.effective_mass[c] < kSquareOfTime;
}

/// By its stretch: a triangle gives way to shear as fabric does to forces of its own weight.
bool is_fast(const reference::MembraneElement& e) {
  const double stiffness = std::max(e.stiffness[0], e.stiffness[1]) * e.shape.area;
  return stiffness * e.mobility.most() * kSquareOfTime > 1;
}

double change_of(const MembraneStore& s, std::uint32_t i, const kernels::Vectors& from,
                 const kernels::Vectors& to) {
  const auto before = deformation_of(s, from, i), after = deformation_of(s, to, i);
  double most = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    if (s.element[i].stiffness[k] == 0) continue;
    most = std::max(
        most, std::abs(term(s.element[i], after, k).error - term(s.element[i], before, k).error));
  }
  return most;
}

}  // namespace

double softest_of_fast(const Model& model) {
  const ConstraintStore& s = model.constraints;
  double most = 0;
  for (const reference::MembraneElement& e : model.membrane.element) {
    if (is_fast(e)) most = std::numeric_limits<float>::min();
  }
  if (!s.has_springs()) return most;
  for (std::uint32_t c = 0; c < s.size(); ++c) {
    if (is_fast(s, c)) most = std::max(most, s.compliance[c]);
  }
  return most;
}

double largest_change_of_fast(const Model& model, const kernels::Vectors& from,
                              const kernels::Vectors& to) {
  const ConstraintStore& s = model.constraints;
  double most = 0;
  for (std::uint32_t c = 0; s.has_springs() && c < s.size(); ++c) {
    if (!is_fast(s, c)) continue;
    const double change = length(to[s.a[c]] - to[s.b[c]]) - length(from[s.a[c]] - from[s.b[c]]);
    most = std::max(most, std::abs(change) / s.rest_length[c]);
  }
  for (std::uint32_t i = 0; i < model.membrane.size(); ++i) {
    if (is_fast(model.membrane.element[i]))
      most = std::max(most, change_of(model.membrane, i, from, to));
  }
  return most;
}

bool fast_rest_differs(const Model& a, const Model& b, double strain) {
  bool differs = false;
  if (!a.constraints.has_springs() || !b.constraints.has_springs()) return false;
  for_each_constraint(a, b, [&](std::uint32_t i, std::uint32_t k) {
    const double rest = a.constraints.rest_length[i], other = b.constraints.rest_length[k];
    differs = differs || (is_fast(a.constraints, i) && std::abs(rest - other) > strain * rest);
  });
  return differs;
}

}  // namespace weft
