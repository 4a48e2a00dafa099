#include "engine/step/motion.h"

#include <atomic>
#include <span>

#include "engine/measure/state_measure.h"

namespace weft {

reference::Motion reference_motion(State& s) {
  reference::Motion m;
  m.particles = s.model->slots();
  m.inverse_mass = s.model->inverse_mass.data();
  m.gravity = s.gravity;
  if (s.forces().size() > 0) m.force = s.forces().view();
  m.position = s.position.view();
  m.velocity = s.velocity.view();
  m.predicted = s.predicted.view();
  m.solved = s.solved.view();
  return m;
}

namespace {

simd::Motion simd_motion(State& s) {
  simd::Motion m;
  m.inverse_mass = s.model->inverse_mass.data();
  m.mass = s.model->mass.data();
  m.gravity = s.gravity;
  if (s.forces().size() > 0) m.force = s.forces().view();
  m.position = s.position.view();
  m.velocity = s.velocity.view();
  m.solved = s.solved.view();
  m.next_velocity = s.next_velocity.view();
  return m;
}

/// Per slot, 0 of free spheres that touch nothing: they fly by themselves, and of a fast and heavy
/// one the rounding alone may be worth more than the energy of a cloth.
const double* inverse_mass_of_met(State& s) {
  const Model& model = *s.model;
  if (model.heaviest_sphere == 0) return model.inverse_mass.data();
  s.inverse_mass_of_met = model.inverse_mass;
  for (const std::uint32_t slot : model.spheres) {
    if (touches_nothing(model, s.contacts, slot)) s.inverse_mass_of_met[slot] = 0;
  }
  return s.inverse_mass_of_met.data();
}

kernels::ImpulseEnergy sum(std::span<const kernels::ImpulseEnergy> of_stretches) {
  kernels::ImpulseEnergy sum;
  for (const kernels::ImpulseEnergy& impulses : of_stretches) sum.add(impulses);
  return sum;
}

}  // namespace

void predict(State& s, double h, Team& team) {
  if (s.settings.backend == Backend::reference) return reference::predict(reference_motion(s), h);
  const simd::Motion motion = simd_motion(s);
  team.for_each_part(s.model->slots(), kStretch, [&](std::size_t first, std::size_t last) {
    s.kernels->predict(motion, h, first, last);
  });
}

bool commit(State& s, double h, Team& team) {
  if (s.settings.backend == Backend::reference) {
    reference::commit(reference_motion(s), h, s.next_velocity.view());
    return all_finite(s.solved) && all_finite(s.next_velocity);
  }
  const simd::Motion motion = simd_motion(s);
  std::atomic<bool> finite{true};
  team.for_each_part(s.model->slots(), kStretch, [&](std::size_t first, std::size_t last) {
    if (!s.kernels->commit(motion, h, first, last)) finite.store(false, std::memory_order_relaxed);
  });
  return finite;
}

bool commit(State& s, double h, kernels::ImpulseEnergy& impulses, Team& team) {
  if (s.settings.backend == Backend::reference) {
    const bool finite = commit(s, h, team);
    impulses = measure_impulses(s, h, team);
    return finite;
  }
  const simd::Motion motion = simd_motion(s);
  std::atomic<bool> finite{true};
  team.for_each_part(s.model->slots(), kStretch, [&](std::size_t first, std::size_t last) {
    if (!s.kernels->commit_watched(motion, h, first, last, s.impulses[first / kStretch]))
      finite.store(false, std::memory_order_relaxed);
  });
  impulses = sum(s.impulses);
  return finite;
}

kernels::ImpulseEnergy measure_impulses(State& s, double h, Team& team) {
  if (s.settings.backend == Backend::reference) {
    return reference::measure_impulses(reference_motion(s), h, s.next_velocity.view());
  }
  const simd::Motion motion = simd_motion(s);
  team.for_each_part(s.model->slots(), kStretch, [&](std::size_t first, std::size_t last) {
    s.impulses[first / kStretch] = s.kernels->measure_impulses(motion, h, first, last);
  });
  return sum(s.impulses);
}

kernels::ImpulseEnergy measure_energy_change(State& s, Team& team) {
  const double* inverse_mass = inverse_mass_of_met(s);
  if (s.settings.backend == Backend::reference) {
    reference::Motion motion = reference_motion(s);
    motion.inverse_mass = inverse_mass;
    return reference::measure_impulses(motion, 1, s.next_velocity.view());
  }
  simd::Motion motion = simd_motion(s);
  motion.inverse_mass = inverse_mass;
  team.for_each_part(s.model->slots(), kStretch, [&](std::size_t first, std::size_t last) {
    s.impulses[first / kStretch] = s.kernels->measure_energy_change(motion, first, last);
  });
  return sum(s.impulses);
}

}  // namespace weft
