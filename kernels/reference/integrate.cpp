#include "kernels/reference/integrate.h"

namespace weft::reference {

using kernels::Vector;

void predict(const Motion& m, double h) {
  for (std::size_t i = 0; i < m.particles; ++i) {
    const Vector p = preview(m, i, h);
    m.predicted.set(i, p);
    m.solved.set(i, p);
  }
}

void commit(const Motion& m, double h, const kernels::VectorsView& next_velocity) {
  for (std::size_t i = 0; i < m.particles; ++i) {
    const Vector displacement = m.solved[i] - m.predicted[i];
    next_velocity.set(i, m.velocity[i] + h * acceleration(m, i) + (1 / h) * displacement);
  }
}

kernels::ImpulseEnergy measure_impulses(const Motion& m, double h,
                                        const kernels::VectorsView& next_velocity) {
  kernels::ImpulseEnergy sum;
  for (std::size_t i = 0; i < m.particles; ++i) {
    const double w = m.inverse_mass[i];
    if (w == 0) continue;
    const Vector v = m.velocity[i], next = next_velocity[i], a = acceleration(m, i);
    const Vector first = (1 / h) * (m.solved[i] - m.predicted[i]);
    const Vector second = next - (v + h * a + first);
    const double square = dot(next, next);
    const double gain = square - dot(v, v) - 2 * dot(a, m.solved[i] - m.position[i]);
    sum.add({dot(first, first) / w, dot(second, second) / w, gain / w, square / w});
  }
  return sum;
}

}  // namespace weft::reference
