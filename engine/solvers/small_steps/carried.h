/// The loads of the elements of a model that may tear: the mean over the substeps of a frame.
///
/// The multiplier of a law after the sweep of a substep is the impulse that moved the particles.
/// Mending is left out: it moves positions and no velocities. In a cloth at rest these impulses
/// balance the load in each substep, however stiff the laws are. So the mean is the force, and
/// exact under a load. Where pins stretch a fabric that is stiffer than substeps resolve, it
/// is the force of the fabric as it is solved, which is softer (tests/README.md).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/bytes_of.h"
#include "engine/model/model.h"
#include "engine/solvers/small_steps/linkage.h"
#include "engine/solvers/small_steps/seams.h"

namespace weft {

struct Carried {
  std::vector<double> constraints;               // N, along each; a pull is positive
  std::vector<std::array<double, 3>> triangles;  // N/m: along warp and weft, shear
  std::vector<double> seams;                     // N
};

class CarriedForces {
 public:
  explicit CarriedForces(const Model& model) : model_(model) {
    if (!model.may_tear) return;
    sum_.constraints.resize(model.constraints.size());
    sum_.triangles.resize(model.membrane.size());
    sum_.seams.resize(model.seams.size());
  }

  void begin(int substeps) {
    share_ = 1.0 / substeps;
    std::ranges::fill(sum_.constraints, 0);
    std::ranges::fill(sum_.triangles, std::array<double, 3>{});
    std::ranges::fill(sum_.seams, 0);
  }
  /// After the sweep of a substep. scale: 1 / (b h)^2 of it, 1/s^2.
  template <class Points>
  void add(const Points& points, const Linkage& linkage, const SeamThreads& seams, double scale) {
    const double by = share_ * scale;
    const ConstraintStore& s = model_.constraints;
    const auto impulse = [&](std::uint32_t c) {
      if (linkage.empty()) return points.multiplier(c);
      return linkage.impulse(c) * length(points.difference(s.a[c], s.b[c]));
    };
    const bool tells = s.has_springs() || !linkage.empty();
    for (std::uint32_t c = 0; tells && c < s.size(); ++c) sum_.constraints[c] += by * impulse(c);
    for (std::uint32_t i = 0; i < sum_.triangles.size(); ++i) {
      const auto multipliers = points.membrane_multipliers(i);
      const double over = by / model_.membrane.element[i].shape.area;
      for (std::size_t k = 0; k < 3; ++k) sum_.triangles[i][k] += over * multipliers[k];
    }
    for (std::size_t i = 0; i < sum_.seams.size(); ++i)
      sum_.seams[i] += by * length(seams.multiplier(i));
  }
  const Carried& mean() const { return sum_; }
  std::size_t bytes() const {
    return bytes_of(sum_.constraints) + bytes_of(sum_.triangles) + bytes_of(sum_.seams);
  }

 private:
  const Model& model_;
  Carried sum_;
  double share_ = 1;
};

}  // namespace weft
