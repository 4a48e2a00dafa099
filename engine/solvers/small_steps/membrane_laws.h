/// The laws of triangles of fabric (kernels/reference/membrane.h), one after the other.
///
/// points: difference(a, b), start_difference(a, b) and move(slot, by) as for constraints (laws.h);
/// membrane_multipliers(element) and set_membrane_multipliers(element, to).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/laws.h"

namespace weft {

inline reference::MembraneStep membrane_step(const LawStep& step) {
  return {1 / step.springs.scale, step.damping_of_triangles};
}

/// 1/s^2, the largest stiffness of a law over the mass that it moves, at rest; 0: there are none.
inline double stiffest_law(const MembraneStore& s) {
  double most = 0;
  for (const auto& [shape, mobility, stiffness, is_rope] : s.element) {
    const double stretch = std::max(stiffness[0] * mobility.uu, stiffness[1] * mobility.vv);
    const double shear = stiffness[2] * (mobility.uu + mobility.vv);
    most = std::max(most, shape.area * std::max(stretch, shear));
  }
  return most;
}

/// An element where the particles are, and where they were when the substep began.
struct MembraneLook {
  reference::Deformation now{}, start{};
};

template <class Points>
MembraneLook look_at_element(const MembraneStore& s, const Points& points,
                             const reference::MembraneStep& step, std::uint32_t i) {
  const auto& [p0, p1, p2] = s.slots[i];
  const reference::MembraneShape& shape = s.element[i].shape;
  MembraneLook look;
  look.now = deformation(shape, points.difference(p1, p0), points.difference(p2, p0));
  if (step.damping > 0) {
    look.start =
        deformation(shape, points.start_difference(p1, p0), points.start_difference(p2, p0));
  }
  return look;
}

/// The largest of the element's laws.
template <class Points>
double violation_of_element(const MembraneStore& s, const Points& points, const LawStep& laws,
                            std::uint32_t i) {
  if (laws.leaves_triangles()) return 0;
  const reference::MembraneStep step = membrane_step(laws);
  const MembraneLook look = look_at_element(s, points, step, i);
  return violation(s.element[i], step, look.now, look.start, points.membrane_multipliers(i));
}

/// The largest error of all elements.
template <class Points>
double largest_violation(const MembraneStore& s, const Points& points, const LawStep& laws) {
  double most = 0;
  for (std::uint32_t i = 0; i < s.size(); ++i)
    most = std::max(most, violation_of_element(s, points, laws, i));
  return most;
}

/// Goes on from the multipliers that points have. Strains up to `left` are left.
template <class Points>
void relax_element(const Model& model, Points& points, const LawStep& laws, double omega,
                   std::uint32_t i, double left = 0) {
  const MembraneStore& s = model.membrane;
  const reference::MembraneStep step = membrane_step(laws);
  const MembraneLook look = look_at_element(s, points, step, i);
  reference::MembraneMultipliers multipliers = points.membrane_multipliers(i);
  const reference::MembraneElement& element = s.element[i];
  const reference::Deformation push =
      relax(element, step, omega, look.now, look.start, multipliers, left);
  points.set_membrane_multipliers(i, multipliers);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t slot = s.slots[i][k];
    points.move(slot, -model.inverse_mass[slot] *
                          (element.shape.u[k] * push.u + element.shape.v[k] * push.v));
  }
}

}  // namespace weft
