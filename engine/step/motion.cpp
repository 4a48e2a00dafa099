#include "engine/step/motion.h"

#include <atomic>
#include <span>

#include "engine/step/measure.h"

namespace weft {

reference::Motion reference_motion(State& s) {
  reference::Motion m;
  m.particles = s.model->slots();
  m.inverse_mass = s.model->inverse_mass.data();
  m.gravity = s.gravity;
  if (s.force.size() > 0) m.force = s.force.view();
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
  if (s.force.size() > 0) m.force = s.force.view();
  m.position = s.position.view();
  m.velocity = s.velocity.view();
  m.solved = s.solved.view();
  m.next_velocity = s.next_velocity.view();
  return m;
}

kernels::Kicks sum(std::span<const kernels::Kicks> of_stretches) {
  kernels::Kicks sum;
  for (const kernels::Kicks& kicks : of_stretches) sum.add(kicks);
  return sum;
}

}  // namespace

void predict(State& s, double h, Team& team) {
  if (s.reference) return reference::predict(reference_motion(s), h);
  const simd::Motion motion = simd_motion(s);
  team.for_each_part(s.model->slots(), kStretch, [&](std::size_t first, std::size_t last) {
    s.kernels->predict(motion, h, first, last);
  });
}

bool commit(State& s, double h, Team& team) {
  if (s.reference) {
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

bool commit(State& s, double h, kernels::Kicks& kicks, Team& team) {
  if (s.reference) {
    const bool finite = commit(s, h, team);
    kicks = measure_kicks(s, h, team);
    return finite;
  }
  const simd::Motion motion = simd_motion(s);
  std::atomic<bool> finite{true};
  team.for_each_part(s.model->slots(), kStretch, [&](std::size_t first, std::size_t last) {
    if (!s.kernels->commit_watched(motion, h, first, last, s.kicks[first / kStretch]))
      finite.store(false, std::memory_order_relaxed);
  });
  kicks = sum(s.kicks);
  return finite;
}

kernels::Kicks measure_kicks(State& s, double h, Team& team) {
  if (s.reference) {
    return reference::measure_kicks(reference_motion(s), h, s.next_velocity.view());
  }
  const simd::Motion motion = simd_motion(s);
  team.for_each_part(s.model->slots(), kStretch, [&](std::size_t first, std::size_t last) {
    s.kicks[first / kStretch] = s.kernels->measure_kicks(motion, h, first, last);
  });
  return sum(s.kicks);
}

kernels::Kicks measure_energy_change(State& s, Team& team) {
  if (s.reference) return measure_kicks(s, 1, team);
  const simd::Motion motion = simd_motion(s);
  team.for_each_part(s.model->slots(), kStretch, [&](std::size_t first, std::size_t last) {
    s.kicks[first / kStretch] = s.kernels->measure_energy_change(motion, first, last);
  });
  return sum(s.kicks);
}

}  // namespace weft
