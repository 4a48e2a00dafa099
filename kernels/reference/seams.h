/// A seam in double: two particles that are drawn together and then held (weft.h, Seam). Local
/// passes know nothing of it; sweeps end with it, and so does what puts a substep right.
///
/// d is the way from b to a. In a substep of h that began with the way d_0, an open seam asks for
///
///     d = d_0 max(0, 1 - speed h / |d_0|)
///
/// so that it closes along a straight line and never faster than at `speed`, however far behind it
/// is. Its impulse of a substep is a force over (b h)^2 and has an end. A closed one asks for d =
/// 0.
#pragma once

#include <algorithm>

#include "kernels/vectors.h"

namespace weft::reference {

/// The task of a seam in a substep of h.
struct SeamTask {
  kernels::Vector wanted{};  // m, the way from b to a
  double most = 0;           // kg m, of the multiplier; infinite: no limit

  static SeamTask of_open(kernels::Vector start, double speed, double h, double most) {
    const double l = length(start);
    const double left = l > 0 ? std::max(0.0, 1 - speed * h / l) : 0;
    return {left * start, most};
  }
};

/// The change of the multiplier that leads from d to what is wanted, or as far as it may.
inline kernels::Vector seam_impulse(const SeamTask& task, kernels::Vector d, double inverse_masses,
                                    kernels::Vector multiplier) {
  const kernels::Vector next = multiplier + (1 / inverse_masses) * (d - task.wanted);
  const double size = length(next);
  return (size > task.most ? (task.most / size) * next : next) - multiplier;
}

}  // namespace weft::reference
