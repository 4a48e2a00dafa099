#include "engine/energy.h"

#include <cmath>

namespace weft {
namespace {

using kernels::Vector;

/// Twice the energies of the free particles.
struct Energies {
  double gain = 0;     // sum m |v'|^2 - m |v|^2 - 2 m a . (x' - x)
  double kinetic = 0;  // sum m |v'|^2
};

Energies measure(const State& s) {
  Energies sum;
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    const double w = s.model->inverse_mass[slot];
    if (w == 0) continue;
    Vector a = s.gravity;
    if (s.force.size() > 0) a = a + w * s.force[slot];
    const Vector v = s.velocity[slot], next = s.next_velocity[slot];
    const double kinetic = dot(next, next) / w;
    sum.kinetic += kinetic;
    sum.gain += kinetic - (dot(v, v) + 2 * dot(a, s.solved[slot] - s.position[slot])) / w;
  }
  return sum;
}

}  // namespace

void take_gained_energy(State& s) {
  const Energies twice = measure(s);
  if (!(twice.gain > 0)) return;
  const double left = twice.gain < twice.kinetic ? std::sqrt(1 - twice.gain / twice.kinetic) : 0;
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    if (s.model->inverse_mass[slot] == 0) continue;
    s.next_velocity.set(slot, left * s.next_velocity[slot]);
  }
}

}  // namespace weft
