#include "engine/step/energy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/measure/state_measure.h"
#include "engine/solvers/small_steps/free_bodies.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/step/motion.h"
#include "engine/step/pin_work.h"
#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::Vector;

Vector middle(const State& s, std::size_t slot) {
  return 0.5 * (s.position[slot] + s.solved[slot]);
}

/// A particle that flies by itself neither gains energy nor gives any.
bool flies_free(const State& s, std::uint32_t slot) {
  return touches_nothing(*s.model, s.contacts, slot);
}

/// Twice the kinetic energy of the motion that differs from the pins', sum m |v' - u|^2.
double twice_kinetic(const State& s, const PinMotion& pins) {
  double sum = 0;
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    const double w = s.model->inverse_mass[slot];
    if (w == 0 || flies_free(s, slot)) continue;
    const Vector apart = s.next_velocity[slot] - pins.at(middle(s, slot));
    sum += dot(apart, apart) / w;
  }
  return sum;
}

/// Returns by how much sum m |v'|^2 falls.
double slow_down(State& s, const PinMotion& pins, double factor) {
  double fall = 0;
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    const double w = s.model->inverse_mass[slot];
    if (w == 0 || flies_free(s, slot)) continue;
    const Vector u = pins.at(middle(s, slot)), v = s.next_velocity[slot];
    const Vector slowed = u + factor * (v - u);
    fall += (dot(v, v) - dot(slowed, slowed)) / w;
    s.next_velocity.set(slot, slowed);
  }
  return fall;
}

/// Bodies that the guard slows down as it does particles; nullptr where there are none.
FreeBodies* free_bodies(const State& s) {
  if (!s.small_steps || s.small_steps->free_bodies().empty()) return nullptr;
  return &s.small_steps->free_bodies();
}

/// J, of what hangs at rest and by scheme paper has the velocity h a / 2.
double energy_at_rest(const State& s, double h) {
  double sum = 0;
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    const double w = s.model->inverse_mass[slot];
    if (w == 0) continue;
    const Vector a = acceleration(s, slot);
    sum += dot(a, a) / w;
  }
  return h * h / 8 * sum;
}

}  // namespace

bool gains_energy(const State& s, const kernels::ImpulseEnergy& impulses, double h) {
  const double allowed =
      tuning::kRattleGain * impulses.second + tuning::kEnergyRounding * impulses.energy;
  const double apart = impulses.first - impulses.second;
  if (std::min(impulses.gain, apart) <= allowed) return false;
  return std::min(impulses.gain - 2 * work_of(motion_of_pins(s, h), s, h), apart) > allowed;
}

double gained_energy(const State& s, const kernels::ImpulseEnergy& change, double h) {
  double gain = 0.5 * change.gain;
  if (pins_move(s)) {
    const PinMotion pins = motion_of_pins(s, h);
    gain -= work_of(pins, s, h) + stray_energy(pins, s);
  }
  return gain;
}

bool take_energy(State& s, double gain, double h, kernels::ImpulseEnergy& change) {
  if (!(gain > 0)) return true;
  const PinMotion pins = pins_move(s) ? motion_of_pins(s, h) : PinMotion{};
  const auto velocity = [&](Vector x) { return pins.at(x); };
  FreeBodies* const bodies = free_bodies(s);
  double kinetic = 0.5 * twice_kinetic(s, pins);
  if (bodies != nullptr) kinetic += bodies->kinetic(velocity, pins.spin);
  const double factor = gain < kinetic ? std::sqrt(1 - gain / kinetic) : 0;
  change.gain -= slow_down(s, pins, factor);
  if (bodies != nullptr) change.gain -= 2 * bodies->slow_down(velocity, pins.spin, factor);
  return gain <= kinetic;
}

bool guard_energy(State& s, kernels::ImpulseEnergy& impulses, bool is_suspect, double h) {
  if (impulses.gain <= 0) return true;
  const double worth = is_suspect ? 0 : tuning::kMostGain * impulses.first;
  const double allowed = 0.5 * (worth + tuning::kEnergyRounding * impulses.energy);
  if (0.5 * impulses.gain <= allowed) return true;
  const double gain = gained_energy(s, impulses, h);
  return gain <= allowed + energy_at_rest(s, h) || take_energy(s, gain, h, impulses);
}

double guard_springs(State& s, double lost, double released, double h,
                     kernels::ImpulseEnergy& change) {
  const double stored = lost * std::exp(-h / tuning::kSpringTime);
  const double gain = gained_energy(s, change, h) - released;
  take_energy(s, gain - stored, h, change);
  // A particle at 1e154 m/s has more energy than a number holds.
  return std::min(std::max(0.0, stored - gain), std::numeric_limits<double>::max());
}

}  // namespace weft
