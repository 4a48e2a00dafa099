#include "engine/step/energy.h"

#include <algorithm>
#include <cmath>

#include "engine/step/motion.h"
#include "engine/step/pin_work.h"
#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::Vector;

/// Of the kick. (0.1: sphere_drop, 21 x 21, does 274 substeps of 200 steps in halves instead of 2.)
constexpr double kMostGain = 0.5;
/// Of the kinetic energy: positions are rounded.
constexpr double kRounding = 1e-9;
/// How much faster than pins that stray what they pull at may rightly become: a taut sheet whose
/// ends are drawn together sags far more quickly than they come. (With 1 a woven sheet whose ends
/// come together at 1 m/s takes 13 iterations a frame instead of 1, for nothing.)
constexpr double kLeverage = 5;

/// Twice the energies of the free particles.
struct Energies {
  double gain = 0;     // sum m |v'|^2 - m |v|^2 - 2 m a . (x' - x)
  double kinetic = 0;  // sum m |v' - u|^2, u: of the pins' motion there
};

Vector middle(const State& s, std::size_t slot) {
  return 0.5 * (s.position[slot] + s.solved[slot]);
}

Energies measure(const State& s, const PinMotion& pins) {
  Energies sum;
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    const double w = s.model->inverse_mass[slot];
    if (w == 0) continue;
    const Vector a = acceleration(s, slot);
    const Vector v = s.velocity[slot], next = s.next_velocity[slot];
    const Vector apart = next - pins.at(middle(s, slot));
    sum.kinetic += dot(apart, apart) / w;
    sum.gain +=
        dot(next, next) / w - (dot(v, v) + 2 * dot(a, s.solved[slot] - s.position[slot])) / w;
  }
  return sum;
}

/// Twice what pins and spheres under way may have brought.
double twice_brought(const State& s, const PinMotion& pins, double h, double leverage) {
  return 2 * (work_of(pins, s, h) + leverage * leverage * stray_energy(pins, s));
}

/// Twice the energy of what hangs at rest, and so has the velocity h a / 2: what is let go gains it
/// in its first substep.
double twice_at_rest(const State& s, double h) {
  double sum = 0;
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    const double w = s.model->inverse_mass[slot];
    if (w == 0) continue;
    const Vector a = acceleration(s, slot);
    sum += dot(a, a) / w;
  }
  return 0.25 * h * h * sum;
}

}  // namespace

bool gains_energy(const State& s, const kernels::Kicks& kicks, double h) {
  const double allowed = kMostGain * kicks.first + kRounding * kicks.energy;
  if (kicks.gain <= allowed) return false;
  const double brought = twice_brought(s, motion_of_pins(s, h), h, kLeverage);
  return kicks.gain - brought - twice_at_rest(s, h) > allowed;
}

namespace {

/// Of the kinetic energy, twice: by how much velocities are to be slowed down.
double factor_without(double gain, double kinetic) {
  if (!(gain > 0)) return 1;
  return gain < kinetic ? std::sqrt(1 - gain / kinetic) : 0;
}

void slow_down(State& s, const PinMotion& pins, double left) {
  if (left == 1) return;
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    if (s.model->inverse_mass[slot] == 0) continue;
    const Vector u = pins.at(middle(s, slot));
    s.next_velocity.set(slot, u + left * (s.next_velocity[slot] - u));
  }
}

}  // namespace

void take_gained_energy(State& s, double h) {
  const PinMotion pins = motion_of_pins(s, h);
  const Energies twice = measure(s, pins);
  slow_down(s, pins, factor_without(twice.gain - twice_brought(s, pins, h, 1), twice.kinetic));
}

void take_gained_energy(State& s, const kernels::Kicks& change, double dt) {
  PinMotion pins;
  double gain = change.gain, kinetic = change.energy;
  if (s.pins.moving()) {
    pins = motion_of_pins(s, dt);
    kinetic = measure(s, pins).kinetic;
    gain -= twice_brought(s, pins, dt, 1);
  }
  const double may_come_back = 2 * s.lost_energy * std::exp(-dt / tuning::kSpringTime);
  slow_down(s, pins, factor_without(gain - may_come_back, kinetic));
  s.lost_energy = std::max(0.0, 0.5 * (may_come_back - gain));
}

}  // namespace weft
