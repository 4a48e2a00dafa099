/// The stages predict and commit, on either backend.
#pragma once

#include "engine/step/state.h"
#include "kernels/reference/integrate.h"

namespace weft {

/// The acceleration of a free particle by gravity and forces.
inline kernels::Vector acceleration(const State& s, std::size_t slot) {
  const kernels::Vectors& force = s.forces();
  return force.size() > 0 ? s.gravity + s.model->inverse_mass[slot] * force[slot] : s.gravity;
}
/// Whether it is no sphere and can move.
inline bool is_free_cloth(const Model& model, std::size_t slot) {
  return model.inverse_mass[slot] != 0 && !(model.has_spheres() && model.is_sphere[slot]);
}
/// The motion that the reference's stages work on.
reference::Motion reference_motion(State& s);
/// solved: where the particles would be after h without constraints.
void predict(State& s, double h, Team& team);
/// next_velocity: from solved. Returns whether both are finite.
bool commit(State& s, double h, Team& team);
/// And what the position loop's impulses did.
bool commit(State& s, double h, kernels::ImpulseEnergy& impulses, Team& team);
/// The energy of the impulses of a substep (engine/step/energy.h).
kernels::ImpulseEnergy measure_impulses(State& s, double h, Team& team);
/// Gain and energy alone, of a whole step; without spheres that touch nothing.
kernels::ImpulseEnergy measure_energy_change(State& s, Team& team);

}  // namespace weft
