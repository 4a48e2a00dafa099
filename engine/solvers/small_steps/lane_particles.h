/// Particles of small steps in lanes as contacts with meshes see them.
#pragma once

#include "engine/solvers/small_steps/lane_points.h"
#include "engine/solvers/small_steps/point_particles.h"

namespace weft {

using LaneParticles = PointParticles<LanePoints>;

inline void LanePoints::grip(std::uint32_t slot) const {
  SimdBodies::Particle particle{position_at_start(slot), position(slot), settled(slot)};
  const TouchedSurface surface = bodies->hold(slot, particle);
  if (surface.is_there()) {
    put(slot, particle.x, particle.v);
    put_start(slot, particle.start);
    if (bodies->begins_to_touch(slot)) arrived.push_back({slot, surface});
  }
  if (!bodies->has_meshes()) return;
  LaneParticles particles(*this);
  bodies->hold_by_meshes(slot, particles);
}

}  // namespace weft
