#include "engine/step/burden.h"

#include <algorithm>
#include <cstdint>

#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/spheres/sphere_contacts.h"
#include "engine/step/motion.h"
#include "engine/step/pressure.h"

namespace weft {
namespace {

using kernels::Vector;

Vector mean_velocity(const State& s, const std::vector<std::uint32_t>& slots) {
  Vector sum{0, 0, 0};
  for (const std::uint32_t slot : slots) sum = sum + s.velocity[slot];
  return slots.empty() ? sum : (1 / static_cast<double>(slots.size())) * sum;
}

/// m/s^2. Cloth that swings from its pins without a gravity pulls as one does that has come to the
/// bottom of its swing, by this gravity, with its mean energy.
double acceleration_of_swing(const State& s) {
  const Model& model = *s.model;
  const double reach = model.small_steps().load.reach;
  if (reach == 0 || model.holds.empty()) return 0;
  const Vector of_pins = mean_velocity(s, model.holds);
  double energy = 0, mass = 0;
  for (std::uint32_t slot = 0; slot < model.slots(); ++slot) {
    if (!is_free_cloth(model, slot)) continue;
    const Vector v = s.velocity[slot] - of_pins;
    energy += 0.5 * model.mass[slot] * dot(v, v);
    mass += model.mass[slot];
  }
  return mass > 0 ? energy / (mass * reach) : 0;
}

/// kg, of free spheres that touch something where they lead by their velocities.
double mass_of_spheres(State& s, double dt) {
  const Model& model = *s.model;
  if (model.heaviest_sphere == 0) return 0;
  for (std::uint32_t slot = 0; slot < model.slots(); ++slot)
    s.solved.set(slot, s.position[slot] + dt * s.velocity[slot]);
  find_contacts(model, *s.kernels, s.solved.view(), s.contacts);
  double mass = 0;
  std::uint32_t last = kNoIndex;
  for (const std::uint32_t sphere : s.contacts.sphere) {  // all of a sphere are in a row
    if (sphere != last && model.inverse_mass[sphere] > 0) mass += model.mass[sphere];
    last = sphere;
  }
  return mass;
}

/// (Spheres that touch nothing may move.)
bool do_pins_move(const State& s) {
  return s.pins.moving() && std::ranges::any_of(s.model->holds, [&](std::uint32_t slot) {
           return dot(s.velocity[slot], s.velocity[slot]) > 0;
         });
}

}  // namespace

/// Pressures pull by their sum: those of a closed surface hold each other.
double mean_acceleration(const State& s) {
  if (s.forces().size() == 0) return length(s.gravity);
  const bool is_pressed = presses(s);
  const kernels::Vectors& force = is_pressed ? s.pressed.beside : s.forces();
  double sum = is_pressed ? length(sum_of_pressure(s)) : 0, mass = 0;
  for (std::uint32_t slot = 0; slot < s.model->slots(); ++slot) {
    if (!is_free_cloth(*s.model, slot)) continue;
    mass += s.model->mass[slot];
    sum += s.model->mass[slot] * length(s.gravity + s.model->inverse_mass[slot] * force[slot]);
  }
  return mass > 0 ? sum / mass : 0;
}

/// Under gravity a swing has no more than it gives, unless the pins whirl the cloth about.
Burden burden_of(State& s, double dt) {
  Burden burden{.acceleration = mean_acceleration(s), .mass = mass_of_spheres(s, dt)};
  if (burden.acceleration == 0 || do_pins_move(s))
    burden.acceleration = std::max(burden.acceleration, acceleration_of_swing(s));
  return burden;
}

}  // namespace weft
