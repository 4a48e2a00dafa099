/// The first and the fourth stage of a step, in double.
#pragma once

#include <cstddef>

#include "kernels/impulse_energy.h"
#include "kernels/vectors.h"

namespace weft::reference {

/// The particles of a step. force may be null (x == nullptr): none besides gravity.
struct Motion {
  std::size_t particles = 0;
  const double* inverse_mass = nullptr;  // 0: fixed, does not move
  kernels::Vector gravity{};
  kernels::VectorsView force{};
  kernels::VectorsView position{}, velocity{};
  kernels::VectorsView predicted{};  // p + h v + h^2 a / 2
  kernels::VectorsView solved{};     // where the position loop works; starts as predicted
};

/// g + F/m; of a fixed particle 0.
inline kernels::Vector acceleration(const Motion& motion, std::size_t i) {
  if (motion.inverse_mass[i] == 0) return {0, 0, 0};
  if (motion.force.x == nullptr) return motion.gravity;
  return motion.gravity + motion.inverse_mass[i] * motion.force[i];
}

/// p + h v + h^2/2 (g + F/m)            (paper eq. 2)
inline kernels::Vector preview(const Motion& motion, std::size_t i, double h) {
  return motion.position[i] + h * motion.velocity[i] + (0.5 * h * h) * acceleration(motion, i);
}

/// predicted = solved = the preview of each particle.
void predict(const Motion& motion, double h);

/// Position and velocity are only read. With D = solved - predicted
///     p(t+h) = solved,   v(t+h) = v + h (g + F/m) + D / h.
/// (The paper prints p(t) + D and h F: without the preview and without 1/m.)
void commit(const Motion& motion, double h, const kernels::VectorsView& next_velocity);

/// Once next_velocity is corrected: by how much it differs from what commit left is the second dv.
kernels::ImpulseEnergy measure_impulses(const Motion& motion, double h,
                                        const kernels::VectorsView& next_velocity);

}  // namespace weft::reference
